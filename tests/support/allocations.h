// Counts what the whole program allocates, and how many bytes in all, by malloc itself: Eigen and SuiteSparse do not go
// through operator new.
//
// Replaces malloc and its kin by counting ones over those of glibc; where the address sanitizer has taken their place,
// asks it to tell. Include in one file of an executable.
#pragma once

#include <atomic>
#include <cerrno>
#include <cstddef>

namespace poinsot::test {
inline constinit std::atomic<long> allocation_count = 0, allocation_bytes = 0;
inline long allocations() {
  return allocation_count.load();
}
inline long allocated_bytes() {
  return allocation_bytes.load();
}
inline void count_allocation(std::size_t size) {
  ++allocation_count;
  allocation_bytes += static_cast<long>(size);
}
}  // namespace poinsot::test

#if defined(__has_feature)  // clang's way to say it
#define POINSOT_HAS_FEATURE(x) __has_feature(x)
#else
#define POINSOT_HAS_FEATURE(x) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || POINSOT_HAS_FEATURE(address_sanitizer)

// of <sanitizer/allocator_interface.h>, which not every compiler brings along
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*)(const volatile void*, std::size_t),
                                                         void (*)(const volatile void*));

namespace poinsot::test {
inline const int kAllocationHook = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t size) { count_allocation(size); }, [](const volatile void*) {});
}  // namespace poinsot::test

#else

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) noexcept {
  poinsot::test::count_allocation(size);
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  poinsot::test::count_allocation(count * size);
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) noexcept {
  poinsot::test::count_allocation(size);
  return __libc_realloc(block, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  poinsot::test::count_allocation(size);
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  *block = memalign(alignment, size);
  return *block ? 0 : ENOMEM;
}
}

#endif
