#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace semigeo::jobs {

/// Returns bytes as base64 with padding. Source: RFC 4648, section 4.
std::string base64(std::span<const std::byte> bytes);

/// Returns the bytes of numbers, in the order of this machine, as base64.
template <typename Number>
std::string base64_of(const std::vector<Number>& numbers) {
  return base64(std::as_bytes(std::span(numbers)));
}

}  // namespace semigeo::jobs
