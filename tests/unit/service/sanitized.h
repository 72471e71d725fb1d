#pragma once

namespace afterglow {

/// Whether this was compiled with a sanitizer that takes address space without end, so that it cannot be
/// limited.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool takes_all_address_space = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool takes_all_address_space = true;
#else
inline constexpr bool takes_all_address_space = false;
#endif
#else
inline constexpr bool takes_all_address_space = false;
#endif

}  // namespace afterglow
