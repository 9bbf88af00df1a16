# lucent_library(NAME SOURCES ... [LOOPS ...] LINKS ...): one folder of src/, one library. LOOPS are sources that go over
# all pixels, vertices or triangles of something: for the web they are made fast, all others small.
function(lucent_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LOOPS;LINKS" ${ARGN})
  add_library(lucent_${name} STATIC ${ARG_SOURCES} ${ARG_LOOPS})
  if(EMSCRIPTEN AND ARG_LOOPS)
    set_property(SOURCE ${ARG_LOOPS} APPEND PROPERTY COMPILE_OPTIONS -O2 -sINLINING_LIMIT=0)
    set_property(SOURCE ${ARG_LOOPS} PROPERTY SKIP_PRECOMPILE_HEADERS ON) # which are made to be small
  endif()
  lucent_target(lucent_${name})
  target_include_directories(lucent_${name} PUBLIC ${PROJECT_SOURCE_DIR}/src)
  foreach(link ${ARG_LINKS})
    if(TARGET lucent_${link})
      target_link_libraries(lucent_${name} PUBLIC lucent_${link})
    else()
      target_link_libraries(lucent_${name} PUBLIC ${link})
    endif()
  endforeach()
  lucent_precompile(lucent_${name})
endfunction()

# Language, warnings and floating-point rules that all our targets share. No fast-math: numbers must travel.
function(lucent_target target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wnon-virtual-dtor -Werror -ffp-contract=off)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # GCC 12 sees overlapping copies in string concatenation where there are none (GCC bug 105651).
    target_compile_options(${target} PRIVATE -Wno-restrict)
  endif()
  if(NOT ${target} STREQUAL lucent_cli)
    target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-fno-exceptions>)
  endif()
  if(LUCENT_SANITIZE)
    # Their code hides from GCC what its warnings follow, such as how long a text can be: these are no errors here.
    target_compile_options(${target} PUBLIC -fsanitize=address,undefined -fno-sanitize-recover=undefined
                                            -fno-omit-frame-pointer)
    target_compile_options(${target} PRIVATE -Wno-error)
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
  endif()
  if(EMSCRIPTEN)
    target_compile_options(${target} PRIVATE ${LUCENT_SMALL} $<$<COMPILE_LANGUAGE:CXX>:-fno-rtti>)
  endif()
endfunction()

# For the web, what nearly every file includes is read once, by lucent_base, and taken from there by all others: half of
# what Clang does. GCC gains a quarter only, and then warns of code in the library's headers.
function(lucent_precompile target)
  if(NOT EMSCRIPTEN)
    return()
  elseif(${target} STREQUAL lucent_base)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <cstdint> <cstdio> <functional> <limits> <map>
      <memory> <numbers> <optional> <span> <string> <string_view> <variant> <vector> <glm/glm.hpp>
      <glm/gtc/matrix_transform.hpp>)
  else()
    target_precompile_headers(${target} REUSE_FROM lucent_base)
  endif()
endfunction()
