# cmake -DSOURCE=checkout -DOUTPUT=header -P commit.cmake: writes commit and dirty flag of the checkout, touching the
# header only when they changed. Outside a checkout (a tarball, no git) the commit is "unknown".
cmake_minimum_required(VERSION 3.25)
set(commit unknown)
set(dirty false)
find_program(GIT git)
# safe.directory: a build as another user than the owner of the checkout may still read it.
macro(git result)
  execute_process(COMMAND ${GIT} -c safe.directory=${SOURCE} -C ${SOURCE} --no-optional-locks ${ARGN}
                  OUTPUT_VARIABLE ${result} RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
endmacro()
if(GIT)
  # A tarball unpacked inside some other project's checkout is not that project's commit.
  git(prefix rev-parse --show-prefix)
  if(NOT failed AND prefix STREQUAL "")
    git(head rev-parse HEAD)
    if(NOT failed)
      set(commit ${head})
      git(changes status --porcelain)
      if(failed OR changes)
        set(dirty true)
      endif()
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
#pragma once
namespace poinsot::build {
inline constexpr char commit[] = "@commit@";
inline constexpr bool dirty = @dirty@;
}  // namespace poinsot::build
]] @ONLY)
