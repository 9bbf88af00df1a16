# libtiff for WebAssembly from Debian's source package: what reads files without further libraries. Its own build would ask
# the compiler some hundred questions whose answers are known.
set(source ${LUCENT_PACKAGES}/tiff/libtiff)
set(configured ${CMAKE_BINARY_DIR}/tiff)
foreach(type INT UINT)
  foreach(bits 8 16 32 64)
    string(TOLOWER ${type}${bits}_t TIFF_${type}${bits}_T)
  endforeach()
endforeach()
set(TIFF_SSIZE_T int32_t)
set(SIZEOF_SIZE_T 4)
set(HOST_FILLORDER FILLORDER_LSB2MSB)
set(HOST_BIG_ENDIAN 0)
set(STRIP_SIZE_DEFAULT 8192)
set(TIFF_MAX_DIR_COUNT 1048576)
foreach(yes HAVE_ASSERT_H HAVE_FCNTL_H HAVE_IEEEFP HAVE_STRINGS_H HAVE_SYS_TYPES_H HAVE_UNISTD_H LZW_SUPPORT
            PACKBITS_SUPPORT ZIP_SUPPORT DEFAULT_EXTRASAMPLE_AS_ALPHA)
  set(${yes} 1)
endforeach()
configure_file(${source}/tiffconf.h.cmake.in ${configured}/tiffconf.h)
configure_file(${source}/tif_config.h.cmake.in ${configured}/tif_config.h)

set(files aux close codec color compress dir dirinfo dirread dirwrite dumpmode error extension flush getimage hash_set lzw
          open packbits predict print read strip swab tile unix version warning write zip)
list(TRANSFORM files PREPEND ${source}/tif_)
list(TRANSFORM files APPEND .c)
add_library(tiff STATIC ${files})
target_include_directories(tiff SYSTEM PUBLIC ${configured} ${source})
target_link_libraries(tiff PUBLIC zlib)
target_compile_options(tiff PRIVATE ${LUCENT_SMALL} -w) # a package's own warnings are not ours
