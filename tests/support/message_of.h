// SPDX-License-Identifier: Apache-2.0
/// \file
/// What an error says, for tests that compare its words.
#pragma once

#include <string>

namespace relief::test {

/// The words of the Error that `call` throws; "no error" if it throws none. Any other exception
/// passes.
template <class Error, class Call>
std::string message_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

}  // namespace relief::test
