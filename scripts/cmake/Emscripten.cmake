# The Emscripten toolchain of whoever is on the PATH: Debian's package or the user's own SDK.
find_program(EMCC emcc REQUIRED)
file(REAL_PATH ${EMCC} EMCC_REAL)
get_filename_component(EMSCRIPTEN_ROOT ${EMCC_REAL} DIRECTORY)
set(EMSCRIPTEN_TOOLCHAIN ${EMSCRIPTEN_ROOT}/cmake/Modules/Platform/Emscripten.cmake)
if(NOT EXISTS ${EMSCRIPTEN_TOOLCHAIN})
  message(FATAL_ERROR "emcc is at ${EMCC_REAL}, but ${EMSCRIPTEN_TOOLCHAIN} does not exist; "
                      "install it with: apt-get install emscripten")
endif()
include(${EMSCRIPTEN_TOOLCHAIN})

# Debian's emcc finds acorn, which it needs at -O2 and above when it links, only with this path.
# Always written into the build: the shell that configures may know it and the one that links may not.
if(EXISTS /usr/share/nodejs)
  foreach(language C CXX)
    set(CMAKE_${language}_LINKER_LAUNCHER ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs)
  endforeach()
endif()
