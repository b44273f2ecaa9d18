#pragma once

namespace semigeo::tests {

/// Tells whether this build has the address or the thread sanitizer. They need terabytes of address
/// space, so that a test that limits it cannot run.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace semigeo::tests
