# What core/provenance.cpp reports: poinsot_build.h, known when configuring, and poinsot_commit.h, looked up at every build.
# Call after all compiler options are set and the library target exists.
get_directory_property(poinsot_options COMPILE_OPTIONS)
string(TOUPPER "${CMAKE_BUILD_TYPE}" poinsot_type)
list(JOIN poinsot_options " " poinsot_options)
string(STRIP "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${poinsot_type}} -std=c++${CMAKE_CXX_STANDARD} ${poinsot_options}"
       poinsot_flags)
string(REGEX REPLACE " +" " " poinsot_flags "${poinsot_flags}")
string(REPLACE "\"" "\\\"" poinsot_flags "${poinsot_flags}")
set(poinsot_generated ${PROJECT_BINARY_DIR}/generated)
file(CONFIGURE OUTPUT ${poinsot_generated}/poinsot_build.h CONTENT [[
#pragma once
namespace poinsot::build {
inline constexpr char version[] = "@PROJECT_VERSION@";
inline constexpr char compiler[] = "@CMAKE_CXX_COMPILER_ID@ @CMAKE_CXX_COMPILER_VERSION@";
inline constexpr char flags[] = "@poinsot_flags@";
inline constexpr char type[] = "@CMAKE_BUILD_TYPE@";
inline constexpr char cli11[] = "@CLI11_VERSION@";
}  // namespace poinsot::build
]] @ONLY)

add_custom_target(poinsot_commit
                  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DOUTPUT=${poinsot_generated}/poinsot_commit.h
                          -P ${PROJECT_SOURCE_DIR}/cmake/commit.cmake
                  BYPRODUCTS ${poinsot_generated}/poinsot_commit.h COMMENT "Looking up the commit" VERBATIM)
add_dependencies(poinsot poinsot_commit)
target_include_directories(poinsot PRIVATE ${poinsot_generated})
