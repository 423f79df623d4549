# Writes the commit that is built: cmake -DSOURCE=... -DOUT=commit.h -P commit.cmake. The commit has "and changes"
# behind it where files differ from it. Outside of a repository it is VKFV_COMMIT of the environment, or "unknown". A
# file that would not change is left alone.
set(commit unknown)
if(DEFINED ENV{VKFV_COMMIT})
  set(commit $ENV{VKFV_COMMIT})
endif()
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} -C ${SOURCE} rev-parse --short=12 HEAD
                  RESULT_VARIABLE failed OUTPUT_VARIABLE head OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    set(commit ${head})
    execute_process(COMMAND ${GIT} -C ${SOURCE} status --porcelain --untracked-files=no OUTPUT_VARIABLE changes ERROR_QUIET)
    if(changes)
      string(APPEND commit " and changes")
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "inline constexpr const char* commit = \"${commit}\";\n")
