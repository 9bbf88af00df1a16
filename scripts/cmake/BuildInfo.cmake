# Writes BuildInfo.h: the commit that is built, and a fingerprint of the exact solutions' sources.
#
#   cmake -D ROOT=... -D OUT=.../BuildInfo.h -P BuildInfo.cmake
#
# The file is touched only when something in it changes, so that a build with nothing to do stays one.
set(commit unknown)
execute_process(COMMAND git -C ${ROOT} describe --always --dirty=+ --exclude=* --abbrev=7 OUTPUT_VARIABLE described
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(described)
  set(commit ${described})
endif()
file(GLOB sources ${ROOT}/src/truth/*.cpp ${ROOT}/src/truth/*.h)
set(sums)
foreach(source ${sources})
  file(SHA256 ${source} sum)
  string(APPEND sums ${sum})
endforeach()
string(SHA256 truth "${sums}")
configure_file(${ROOT}/src/cli/BuildInfo.h.in ${OUT} @ONLY)
