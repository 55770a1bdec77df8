// Memory for large arrays that are read here and there: in large pages where the system has them,
// so that few addresses have to be translated.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace lobelia {

template <class T>
struct LargePageAllocator {
  using value_type = T;
  LargePageAllocator() = default;
  template <class U>
  LargePageAllocator(const LargePageAllocator<U>&) {}

  T* allocate(size_t count) {
    if (count > static_cast<size_t>(-1) / sizeof(T) - kPage) throw std::bad_array_new_length();
    const size_t bytes = count * sizeof(T);
    const size_t alignment = bytes < kPage ? alignof(T) : kPage;
    // A multiple of the alignment, as aligned_alloc() wants it.
    const size_t size = (bytes + alignment - 1) / alignment * alignment;
    void* memory = std::aligned_alloc(alignment, size);
    if (memory == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    if (bytes >= kPage) madvise(memory, size, MADV_HUGEPAGE);  // a hint: it may fail
#endif
    return static_cast<T*>(memory);
  }
  // Grown vectors hold what happens to be there, so that whoever fills them, in parallel, touches
  // the memory first.
  template <class U>
  void construct(U*) {
    static_assert(std::is_trivially_copyable_v<U>);
  }
  template <class U, class... Arguments>
  void construct(U* at, Arguments&&... arguments) {
    ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
  }
  void deallocate(T* memory, size_t) { std::free(memory); }
  bool operator==(const LargePageAllocator&) const { return true; }

 private:
  static constexpr size_t kPage = size_t{1} << 21;
};

template <class T>
using LargePageVector = std::vector<T, LargePageAllocator<T>>;

}  // namespace lobelia
