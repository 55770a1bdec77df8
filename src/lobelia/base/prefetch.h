// Asking memory for data before it is needed.
#pragma once

namespace lobelia {

inline void prefetchRead(const void* address) {
#if defined(__GNUC__)
  __builtin_prefetch(address);
#else
  (void)address;
#endif
}

// For places spread over more pages than a processor keeps the addresses of, where it may drop what
// prefetchRead() asks for: reads, which waits for nothing either as long as nothing depends on it.
inline void touch(const void* address) { (void)*static_cast<const volatile char*>(address); }

}  // namespace lobelia
