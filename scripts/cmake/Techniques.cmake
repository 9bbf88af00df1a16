# The techniques that are built in: a folder of src/techniques and a name in this list, in the order in which the frame
# calls them. Others can be left out: cmake -DLUCENT_TECHNIQUES=relief
if(NOT LUCENT_TECHNIQUES) # kept in no cache: a folder that was configured before has new ones too
  set(LUCENT_TECHNIQUES relief brdf displacement caustics subsurface throughput refract)
endif()

# lucent_list(LIBRARY HEADER TYPE FUNCTION CONSTANT NAME...): a library in which FUNCTION() answers with the CONSTANT of
# each technique's namespace. Programs link it themselves: it is one of objects, of which none is left out.
function(lucent_list library HEADER TYPE FUNCTION CONSTANT)
  set(DECLARED)
  set(LISTED)
  foreach(technique ${ARGN})
    string(APPEND DECLARED "namespace lucent::${technique} {\nextern const ${TYPE} ${CONSTANT};\n}\n")
    string(APPEND LISTED "&lucent::${technique}::${CONSTANT}, ")
  endforeach()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${library}.cpp)
  configure_file(${PROJECT_SOURCE_DIR}/src/techniques/List.cpp.in ${source} @ONLY)
  add_library(lucent_${library} OBJECT ${source})
  lucent_target(lucent_${library})
  string(REGEX REPLACE "/.*" "" floor ${HEADER})
  target_link_libraries(lucent_${library} PUBLIC lucent_${floor})
  lucent_precompile(lucent_${library})
endfunction()

# lucent_technique_parts(PART[/FILE] LIBRARY HEADER TYPE FUNCTION CONSTANT [NAME...]): what techniques, all without names,
# have on a higher floor, each in its folder techniques/NAME/PART as the library NAME_PART, and the list of those that have
# the folder or the file in it.
function(lucent_technique_parts where library HEADER TYPE FUNCTION CONSTANT)
  string(REGEX REPLACE "/.*" "" part ${where})
  set(having)
  if(NOT ARGN)
    set(ARGN ${LUCENT_TECHNIQUES})
  endif()
  foreach(technique ${ARGN})
    if(EXISTS ${PROJECT_SOURCE_DIR}/src/techniques/${technique}/${where})
      if(NOT TARGET lucent_${technique}_${part})
        add_subdirectory(${PROJECT_SOURCE_DIR}/src/techniques/${technique}/${part})
      endif()
      list(APPEND having ${technique})
    endif()
  endforeach()
  lucent_list(${library} ${HEADER} ${TYPE} ${FUNCTION} ${CONSTANT} ${having})
  list(TRANSFORM having REPLACE "(.+)" "lucent_\\1_${part}")
  target_link_libraries(lucent_${library} PUBLIC ${having})
endfunction()
