# Everything comes from the system's packages.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(fmt 9 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
include(${CMAKE_CURRENT_LIST_DIR}/suitesparse.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/sundials.cmake)
