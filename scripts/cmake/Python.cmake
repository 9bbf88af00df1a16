# LUCENT_PYTHON: Debian's own interpreter if there is one, because it sees the Python modules that Debian packages;
# another one that stands first on the PATH would not.
find_program(LUCENT_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH)
find_program(LUCENT_PYTHON python3 NO_CMAKE_FIND_ROOT_PATH)
if(NOT LUCENT_PYTHON)
  message(FATAL_ERROR "python3 is missing; install it with: apt-get install python3")
endif()
