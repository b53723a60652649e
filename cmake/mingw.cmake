# Toolchain for 64-bit Windows with Debian's MinGW (g++-mingw-w64-x86-64-posix): the preset mingw uses it. Tests run
# under Wine where it is installed. Programs contain the compiler's libraries, so that Wine needs no path to them.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)

# Nothing of this machine is linked.
set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_LIBDIR} /usr/x86_64-w64-mingw32/lib/pkgconfig)

# Debian has GoogleTest and nlohmann's JSON for any compiler: as sources, and as headers.
set(DRAPE_GOOGLETEST /usr/src/googletest CACHE PATH "Sources of GoogleTest")
set(DRAPE_JSON_HEADERS /usr/include/nlohmann CACHE PATH "The folder nlohmann with json.hpp")

find_program(DRAPE_WINE NAMES wine wine64 NO_CMAKE_FIND_ROOT_PATH)
mark_as_advanced(DRAPE_WINE)
if(DRAPE_WINE)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${DRAPE_WINE})
endif()
