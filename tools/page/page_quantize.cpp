// SPDX-License-Identifier: Apache-2.0
#include "page_quantize.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace relief::tools {
using namespace relief::shade;

namespace {

constexpr double largest_code = 65535.0;

double value_of(std::uint16_t code, float min, float max) {
    const auto low = static_cast<double>(min);
    return low + (static_cast<double>(max) - low) * static_cast<double>(code) / largest_code;
}

std::uint16_t code_of(float value, float min, float max) {
    if (!(max > min)) return 0;
    const double low = static_cast<double>(min);
    const double share = (static_cast<double>(value) - low) / (static_cast<double>(max) - low);
    return static_cast<std::uint16_t>(share * largest_code + 0.5);
}

}  // namespace

std::optional<QuantizedFloats> quantized(std::span<const float> values, std::size_t components) {
    QuantizedFloats result;
    if (values.size() < components) return std::nullopt;
    result.min.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(components));
    result.max = result.min;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!std::isfinite(values[i])) return std::nullopt;
        result.min[i % components] = std::min(result.min[i % components], values[i]);
        result.max[i % components] = std::max(result.max[i % components], values[i]);
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float min = result.min[i % components];
        const float max = result.max[i % components];
        result.codes.push_back(code_of(values[i], min, max));
        result.error = std::max(result.error, std::abs(value_of(result.codes.back(), min, max) -
                                                       static_cast<double>(values[i])));
    }
    return result;
}

PageQuantization quantized(const PageDescription& page) {
    PageQuantization result;
    for (const PageMesh& mesh : page.meshes) {
        for (const PageStream& stream : mesh.streams) {
            auto entry = result.sections.find(stream.section);
            if (entry == result.sections.end()) {
                const std::vector<std::byte>& bytes = page.sections[stream.section];
                std::vector<float> values(bytes.size() / sizeof(float));
                std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
                auto made = quantized(values, static_cast<std::size_t>(stream.components));
                if (!made) continue;
                entry = result.sections.emplace(stream.section, std::move(*made)).first;
            }
            double& error = result.errors[stream.attribute];
            error = std::max(error, entry->second.error);
        }
    }
    return result;
}

}  // namespace relief::tools
