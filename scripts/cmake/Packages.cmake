# Finds the packages that scripts/setup installs. A missing one names itself and the command that installs it.
# Headers that live directly in /usr/include reach the compiler through a folder of links, because a WebAssembly
# compiler must never see the machine's own /usr/include.
option(LUCENT_SANITIZE "Address and undefined-behaviour sanitizers" OFF)
set(LUCENT_LINKS ${CMAKE_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${LUCENT_LINKS})

# For the web. With -Oz emcc lets nothing be inlined unless told otherwise: a vector's elements are made by a call each,
# which is slow and no smaller.
set(LUCENT_SMALL -Oz -sINLINING_LIMIT=0 -flto -mbulk-memory)

# lucent_header(FILE PACKAGE TARGET [LINK...]): an interface library around headers of a package
function(lucent_header target package)
  foreach(entry ${ARGN})
    if(NOT EXISTS /usr/include/${entry})
      message(FATAL_ERROR "/usr/include/${entry} is missing; install it with: apt-get install ${package}")
    endif()
    if(NOT EXISTS ${LUCENT_LINKS}/${entry})
      file(CREATE_LINK /usr/include/${entry} ${LUCENT_LINKS}/${entry} SYMBOLIC)
    endif()
  endforeach()
  add_library(${target} INTERFACE)
  target_include_directories(${target} SYSTEM INTERFACE ${LUCENT_LINKS} ${LUCENT_LINKS}/stb)
endfunction()

lucent_header(glm libglm-dev glm)
lucent_header(stb libstb-dev stb)
lucent_header(json nlohmann-json3-dev nlohmann)
lucent_header(tinygltf libtinygltf-dev tiny_gltf.h)
lucent_header(tinyexr libtinyexr-dev tinyexr.h)
lucent_header(eigen libeigen3-dev eigen3)
target_include_directories(eigen SYSTEM INTERFACE ${LUCENT_LINKS}/eigen3)
target_link_libraries(tinygltf INTERFACE json)

# Sources that only exist as Debian source packages; scripts/setup unpacks them.
set(LUCENT_PACKAGES ${PROJECT_SOURCE_DIR}/build/packages CACHE PATH "Unpacked source packages")
foreach(source imgui tiff zlib)
  if(NOT EXISTS ${LUCENT_PACKAGES}/${source})
    message(FATAL_ERROR "${LUCENT_PACKAGES}/${source} is missing; get it with: scripts/setup")
  endif()
endforeach()

add_library(imgui STATIC ${LUCENT_PACKAGES}/imgui/imgui.cpp ${LUCENT_PACKAGES}/imgui/imgui_draw.cpp
                         ${LUCENT_PACKAGES}/imgui/imgui_tables.cpp ${LUCENT_PACKAGES}/imgui/imgui_widgets.cpp)
target_include_directories(imgui SYSTEM PUBLIC ${LUCENT_PACKAGES}/imgui)
target_compile_definitions(imgui PUBLIC IMGUI_DISABLE_DEMO_WINDOWS IMGUI_DISABLE_METRICS_WINDOW
                                        IMGUI_DISABLE_OBSOLETE_FUNCTIONS IMGUI_DISABLE_FILE_FUNCTIONS)
target_compile_features(imgui PUBLIC cxx_std_20)
target_compile_options(imgui PRIVATE -w) # a package's own warnings are not ours

if(EMSCRIPTEN)
  # The compiler's own zlib port would be downloaded.
  set(zlib_sources adler32 crc32 inflate inftrees inffast zutil deflate trees compress uncompr)
  list(TRANSFORM zlib_sources PREPEND ${LUCENT_PACKAGES}/zlib/)
  list(TRANSFORM zlib_sources APPEND .c)
  add_library(zlib STATIC ${zlib_sources})
  target_include_directories(zlib SYSTEM PUBLIC ${LUCENT_PACKAGES}/zlib)
  foreach(target imgui zlib)
    target_compile_options(${target} PRIVATE ${LUCENT_SMALL})
  endforeach()
  target_compile_options(imgui PRIVATE -fno-exceptions -fno-rtti)
  include(${CMAKE_CURRENT_LIST_DIR}/Tiff.cmake)
else()
  find_package(ZLIB REQUIRED)
  add_library(zlib ALIAS ZLIB::ZLIB)
  find_package(TIFF REQUIRED)
  add_library(tiff ALIAS TIFF::TIFF)
  find_package(PkgConfig QUIET)
  find_library(EGL_LIBRARY EGL REQUIRED)
  find_library(GLES_LIBRARY GLESv2 REQUIRED)
  add_library(gles INTERFACE)
  target_link_libraries(gles INTERFACE ${EGL_LIBRARY} ${GLES_LIBRARY})
  lucent_header(cli11 libcli11-dev CLI)
  lucent_header(libzip libzip-dev zip.h zipconf.h)
  find_library(ZIP_LIBRARY zip REQUIRED)
  target_link_libraries(libzip INTERFACE ${ZIP_LIBRARY})
  lucent_header(embree3 libembree-dev embree3)
  find_library(EMBREE_LIBRARY embree3 REQUIRED)
  target_link_libraries(embree3 INTERFACE ${EMBREE_LIBRARY})
endif()
target_link_libraries(tinyexr INTERFACE zlib)

# ccache makes the second build quick wherever it is installed, in another clone as well: paths count from the project.
find_program(CCACHE ccache)
if(CCACHE)
  set(launcher ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=true)
  if(EMSCRIPTEN) # it must be told that a precompiled header may be trusted
    list(APPEND launcher CCACHE_SLOPPINESS=pch_defines,time_macros)
  endif()
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher} ${CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${launcher} ${CCACHE})
endif()
