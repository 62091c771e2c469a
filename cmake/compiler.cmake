# One place for flags. Never -ffast-math: NaN checks, exact zero tests and reproducible sums depend on IEEE arithmetic.
#
# Two of its parts change no result and are on: nobody reads errno after sqrt (-fno-math-errno: sqrt is one instruction,
# and loops with it become vectors), nobody unmasks floating-point traps (-fno-trapping-math: a value that a branch would
# not have needed may be computed, so loops with selections become vectors). Fused multiply-adds round differently; they
# come with the native build only, so that release builds give the same bytes on every processor of an architecture.
add_library(poinsot_warnings INTERFACE)
target_compile_options(poinsot_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror)
# GCC 12 sees overlapping and overlong copies in std::string where there are none (its bugs 105651, 105329).
target_compile_options(poinsot_warnings INTERFACE
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread>)
# Clang asks for the inner braces of an aggregate in an aggregate, which C++ lets be left out.
target_compile_options(poinsot_warnings INTERFACE $<$<CXX_COMPILER_ID:Clang>:-Wno-missing-braces>)
# Of files compiled together clang takes a file's local name to hide a constant that another one keeps to itself.
if(CMAKE_UNITY_BUILD)
  target_compile_options(poinsot_warnings INTERFACE $<$<CXX_COMPILER_ID:Clang>:-Wno-shadow>)
endif()
add_compile_options(-fno-math-errno -fno-trapping-math)

# What a program has to be compiled with as well to fit this library: Eigen's alignment follows the instruction set.
set(poinsot_interface_options)
set(poinsot_interface_link_options)
if(POINSOT_NATIVE)
  list(APPEND poinsot_interface_options -march=native -ffp-contract=fast)
  # g++ 12 takes the deliberately undefined operands of its own AVX-512 intrinsics for uninitialized variables.
  target_compile_options(poinsot_warnings INTERFACE -Wno-maybe-uninitialized)
else()
  add_compile_options(-ffp-contract=off)
endif()
# The formulations are a few large functions of many small ones; g++'s limits on their growth would leave the small ones
# as calls (a fifth more instructions in a step of a small mechanism).
set(poinsot_kernel_options)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT POINSOT_SANITIZE)
  foreach(limit inline-unit-growth=2000 large-function-growth=2000 large-stack-frame-growth=5000
                large-unit-insns=100000 max-inline-insns-single=2000 max-inline-insns-auto=300)
    list(APPEND poinsot_kernel_options --param=${limit})
  endforeach()
  # Below -O2 g++ 12 takes Eigen's evaluators for uninitialized once so much stands in one function.
  list(APPEND poinsot_kernel_options -Wno-maybe-uninitialized)
endif()
# What stands around the solver (studies, reports, commands, tests) is text and tables: half the compile time at -O1, a
# third of that without optimization, which the sanitizers' checks multiply.
set(poinsot_outer_options $<IF:$<CONFIG:Debug>,-O0,-O1>)
set(poinsot_program_options)
set(poinsot_reader_options)
if(POINSOT_SANITIZE)
  # What the address sanitizer finds as well is not checked twice: these five took half of the compile time. (A pointer
  # that overflowed is found where it is used.)
  list(APPEND poinsot_interface_options -fsanitize=address,undefined
       -fno-sanitize=null,object-size,alignment,vptr,pointer-overflow -fno-sanitize-recover=undefined
       -fno-omit-frame-pointer)
  list(APPEND poinsot_interface_link_options -fsanitize=address,undefined)
  # Templates of a shared library are its own: not those of a program compiled without optimization (half the time of its
  # tests).
  string(APPEND CMAKE_SHARED_LINKER_FLAGS " -Wl,-Bsymbolic-functions")
  # What is not the library and computes nothing is checked for its addresses only, a third of its compile time; traces
  # name its functions without lines.
  set(poinsot_program_options -fno-sanitize=undefined -g0)
  # What reads files tells which branches an input takes: it is fuzzed as it stands in this build (tests/fuzz).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    set(poinsot_reader_options -fsanitize-coverage=inline-8bit-counters,pc-table,indirect-calls,trace-cmp)
  endif()
endif()
add_compile_options(${poinsot_interface_options})
add_link_options(${poinsot_interface_link_options})
