# Target poinsot::sundials: IDA as Debian has it. Its own CMake package asks for MPI, PETSc and HYPRE as well, so it is
# found by hand. Serves the build and the installed package.
if(NOT TARGET poinsot::sundials)
  add_library(poinsot::sundials INTERFACE IMPORTED)
  find_path(SUNDIALS_INCLUDE_DIR ida/ida.h REQUIRED)
  mark_as_advanced(SUNDIALS_INCLUDE_DIR)
  target_include_directories(poinsot::sundials INTERFACE ${SUNDIALS_INCLUDE_DIR})
  foreach(part IN ITEMS ida nvecserial)
    find_library(SUNDIALS_${part}_LIBRARY sundials_${part} REQUIRED)
    mark_as_advanced(SUNDIALS_${part}_LIBRARY)
    target_link_libraries(poinsot::sundials INTERFACE ${SUNDIALS_${part}_LIBRARY})
  endforeach()
endif()
