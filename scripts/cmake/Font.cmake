# The library lucent_font: the panel's typeface (Inter Medium, OFL) as bytes, "viewer/FontData.h".
include(Python)
set(font /usr/share/fonts/opentype/inter/Inter-Medium.otf)
if(NOT EXISTS ${font})
  message(FATAL_ERROR "${font} is missing; install it with: apt-get install fonts-inter")
endif()
execute_process(COMMAND ${LUCENT_PYTHON} -c "import fontTools.subset" RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
if(failed)
  message(FATAL_ERROR "${LUCENT_PYTHON} has no module fontTools; install it with: apt-get install fonttools")
endif()

set(generated ${PROJECT_BINARY_DIR}/font/include/viewer)
add_custom_command(
  OUTPUT ${generated}/FontData.cpp ${generated}/FontData.h
  COMMAND ${LUCENT_PYTHON} ${PROJECT_SOURCE_DIR}/scripts/embed_font.py ${font} ${generated}/FontData.cpp
  DEPENDS ${font} ${PROJECT_SOURCE_DIR}/scripts/embed_font.py
  COMMENT "Cutting the font to the characters in use" VERBATIM)
add_library(lucent_font STATIC ${generated}/FontData.cpp ${generated}/FontData.h)
lucent_target(lucent_font)
target_include_directories(lucent_font PUBLIC ${PROJECT_BINARY_DIR}/font/include)
