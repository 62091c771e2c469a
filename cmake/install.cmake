# The installable package: find_package(poinsot) gives poinsot::poinsot. Headers keep their layers below include/poinsot
# and include one another from there ("core/scene.h"); users write <poinsot/core/scene.h>.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
# An installed program finds a shared library beside it, wherever the tree is moved.
set(CMAKE_INSTALL_RPATH $ORIGIN/../${CMAKE_INSTALL_LIBDIR})
set(poinsot_package ${CMAKE_INSTALL_LIBDIR}/cmake/poinsot)

# Before 1.0 every minor version may change the interface.
set_target_properties(poinsot PROPERTIES VERSION ${PROJECT_VERSION}
                                         SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
target_include_directories(poinsot INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
                                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/poinsot>)
target_compile_options(poinsot INTERFACE "$<INSTALL_INTERFACE:${poinsot_interface_options}>")
target_link_options(poinsot INTERFACE "$<INSTALL_INTERFACE:${poinsot_interface_link_options}>")

install(TARGETS poinsot EXPORT poinsot)
install(DIRECTORY core linsolve formulations integrators DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/poinsot
        FILES_MATCHING PATTERN "*.h")

# A further library of the package, poinsot::NAME, of the sources given: its headers are those of the folder. OPTIMIZED
# is one whose loops are met row by row of a long output.
function(poinsot_add_library name)
  cmake_parse_arguments(PARSE_ARGV 1 given OPTIMIZED "" "")
  set(library poinsot_${name})
  add_library(${library} ${given_UNPARSED_ARGUMENTS})
  add_library(poinsot::${name} ALIAS ${library})
  target_link_libraries(${library} PRIVATE fmt::fmt $<BUILD_INTERFACE:poinsot_warnings>)
  if(given_OPTIMIZED)
    target_precompile_headers(${library} REUSE_FROM poinsot_headers)
  else()
    target_compile_options(${library} PRIVATE ${poinsot_outer_options})
    target_precompile_headers(${library} REUSE_FROM poinsot_outer_headers)
  endif()
  set_target_properties(${library} PROPERTIES EXPORT_NAME ${name} VERSION ${PROJECT_VERSION}
                                              SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  install(TARGETS ${library} EXPORT poinsot)
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  install(DIRECTORY ./ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/poinsot/${folder} FILES_MATCHING PATTERN "*.h"
          PATTERN plots EXCLUDE PATTERN page EXCLUDE)
endfunction()

install(EXPORT poinsot NAMESPACE poinsot:: FILE poinsotTargets.cmake DESTINATION ${poinsot_package})
configure_package_config_file(cmake/poinsotConfig.cmake.in ${PROJECT_BINARY_DIR}/poinsotConfig.cmake
                              INSTALL_DESTINATION ${poinsot_package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/poinsotConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/poinsotConfig.cmake ${PROJECT_BINARY_DIR}/poinsotConfigVersion.cmake
              cmake/suitesparse.cmake cmake/sundials.cmake
        DESTINATION ${poinsot_package})
install(DIRECTORY models DESTINATION ${CMAKE_INSTALL_DATADIR}/poinsot)
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
