// SPDX-License-Identifier: Apache-2.0
/// \file
/// Error messages, for tests that compare them.
#pragma once

#include <string>

namespace relief::test {

/// Returns the message of the Error that `call` throws, or "no error". Other exceptions pass
/// through.
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
