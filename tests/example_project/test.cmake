# cmake -DBUILD=build directory -DSOURCE=source directory -DCXX=compiler -P test.cmake: installs the library, moves the
# tree away, builds the example against it with nothing but find_package, and runs it. Nothing of the build or the source
# tree may be needed, so the scene comes from the installed tree as well.
set(work ${BUILD}/tests/example_project)
file(REMOVE_RECURSE ${work})

function(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE failed)
  if(failed)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${work}/first)
file(RENAME ${work}/first ${work}/moved)
run(${CMAKE_COMMAND} -S ${SOURCE}/tests/example_project -B ${work}/build -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${work}/moved -DCMAKE_CXX_FLAGS=-Werror)
run(${CMAKE_COMMAND} --build ${work}/build)
run(${work}/build/example ${work}/moved/share/poinsot/models/single_pendulum.json)
# The driven rod, 2 m to the centre: angle u = (π/4) cos 2t from the vertical, is at (0, 2 sin u, −2 cos u).
if(NOT output MATCHES " -?0\\.000000 -0\\.642106 -1\\.894123\n$")
  message(FATAL_ERROR "the rod ended elsewhere: ${output}")
endif()
run(${work}/build/double_pendulum)
# Lagrange's equations for the two angles, by the classical Runge–Kutta method with steps of 0.1 ms; at rest the hinge
# carries 2/7 of one rod's weight.
if(NOT output MATCHES "^t 0\\.0 lower 1\\.500000 -?0\\.000000 hinge -?0\\.000000 2\\.802857\n")
  message(FATAL_ERROR "the double pendulum started otherwise: ${output}")
endif()
if(NOT output MATCHES "\nt 2\\.0 lower 0\\.115430 -1\\.455662 hinge 13\\.366886 65\\.447720\n$")
  message(FATAL_ERROR "the double pendulum ended elsewhere: ${output}")
endif()
file(WRITE ${work}/pendulum.json [=[{
  "scene": 1, "name": "pendulum", "gravity": [0, 0, -9.81], "parameters": {"l": 1},
  "bodies": [{"name": "rod", "mass": 3, "inertia": [1, "1/100", 1], "position": [0, "l", 0]}],
  "joints": [{"type": "revolute", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 0, 0]}]}]=])
run(${work}/build/parameters ${work}/pendulum.json)
if(NOT output MATCHES "^100 lengths, at most [0-9.]+e-(0[7-9]|[1-9][0-9]) m")
  message(FATAL_ERROR "a pendulum did not come back: ${output}")
endif()
# What was measured differs from run to run; something is on the front, and the explicit pairs are where it is accurate.
run(${work}/build/study ${work}/moved/share/poinsot/models/single_pendulum_free.json)
if(NOT output MATCHES "dop(ri5|853) in r(A|p|eps) [0-9.]+e-[01][0-9] ")
  message(FATAL_ERROR "no front: ${output}")
endif()
file(STRINGS ${work}/moved/lib/cmake/poinsot/poinsotTargets.cmake leaks REGEX "${SOURCE}|${BUILD}")
if(leaks)
  message(FATAL_ERROR "the installed package points back: ${leaks}")
endif()
