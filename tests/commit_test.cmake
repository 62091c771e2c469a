# cmake -DSCRIPT=commit.cmake -DWORK=directory -P commit_test.cmake: what the script says of a plain directory, a fresh
# checkout, a changed one, and a plain directory inside another project's checkout; and that it leaves a header alone that
# is still right (otherwise every build would compile and link again).
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/checkout/vendored ${WORK}/home)
set(ENV{HOME} ${WORK}/home)
set(ENV{GIT_CEILING_DIRECTORIES} ${WORK})
set(header ${WORK}/commit.h)

function(expect source commit dirty)
  execute_process(COMMAND ${CMAKE_COMMAND} -DSOURCE=${source} -DOUTPUT=${header} -P ${SCRIPT}
                  COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${header} text)
  if(NOT text MATCHES "commit\\[\\] = \"${commit}\"" OR NOT text MATCHES "dirty = ${dirty};")
    message(SEND_ERROR "${source}: expected ${commit}, ${dirty}, found\n${text}")
  endif()
endfunction()
function(git)
  execute_process(COMMAND git -C ${WORK}/checkout -c user.name=a -c user.email=a@b ${ARGN} OUTPUT_VARIABLE output
                  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  set(output "${output}" PARENT_SCOPE)
endfunction()

expect(${WORK}/checkout unknown false)
git(init --quiet)
expect(${WORK}/checkout unknown false)
file(WRITE ${WORK}/checkout/file "1")
git(add file)
git(commit --quiet --message first)
git(rev-parse HEAD)
expect(${WORK}/checkout ${output} false)
expect(${WORK}/checkout/vendored unknown false)

expect(${WORK}/checkout ${output} false)
file(TIMESTAMP ${header} before "%s.%f")
expect(${WORK}/checkout ${output} false)
file(TIMESTAMP ${header} after "%s.%f")
if(NOT before STREQUAL after)
  message(SEND_ERROR "the header was written again")
endif()

file(WRITE ${WORK}/checkout/untracked "2")
expect(${WORK}/checkout ${output} true)
file(REMOVE ${WORK}/checkout/untracked)
expect(${WORK}/checkout ${output} false)
file(WRITE ${WORK}/checkout/file "3")
expect(${WORK}/checkout ${output} true)
