# clang-cl takes Clang's own options behind a prefix; Microsoft's compiler has no vector types.
if(MSVC AND NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "Drape needs Clang or MinGW on Windows: -G Ninja -D CMAKE_CXX_COMPILER=clang-cl")
endif()

# drape_target(<target>): how every target of this project is compiled. Nothing of it reaches a user of Drape::drape.
#
# Floating-point contraction is off everywhere: the host must round as the devices do, or contacts differ in their bits.
function(drape_target target)
  target_compile_features(${target} PRIVATE cxx_std_17)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/bullet_plugin/include)
  if(MSVC)
    target_compile_options(${target} PRIVATE /W4 /clang:-ffp-contract=off)
    target_compile_definitions(${target} PRIVATE _CRT_SECURE_NO_WARNINGS _USE_MATH_DEFINES NOMINMAX)
  else()
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -ffp-contract=off)
  endif()
  if(MINGW AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Inline functions are not weak there, so that GCC takes the registers of its own copy for granted. The linker may
    # keep another file's copy, which was compiled for another instruction set or with other optimisation.
    target_compile_options(${target} PRIVATE -fno-ipa-ra)
  endif()
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    # GCC's -Wconversion leaves these two out.
    target_compile_options(${target} PRIVATE -Wno-sign-conversion -Wno-implicit-int-float-conversion)
  endif()
  # Other versions may have warnings that nobody has looked at.
  if(DRAPE_WARNINGS_AS_ERRORS AND "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}" MATCHES
      "^(GNU 12|Clang 14)\\.")
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(NOT DRAPE_DOP EQUAL 18)
    math(EXPR directions "${DRAPE_DOP} / 2")
    target_compile_definitions(${target} PRIVATE DRAPE_DOP_DIRECTIONS=${directions})
  endif()
  if(DRAPE_SANITIZE)
    # Line tables are enough for the sanitizers' reports; full debug information takes a quarter of the compile time.
    target_compile_options(${target} PRIVATE
      -O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
    if(DRAPE_BUILD_FUZZERS)
      target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)  # tells libFuzzer what an input reached
    endif()
    # The option is public, so that every user of a library that calls the sanitizers' run time links it, too.
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
  endif()
endfunction()

# drape_library(<target> <macro>): for what a shared library is made of. Hides all but what DRAPE_EXPORT or
# DRAPE_RECORDER_EXPORT marks (drape/export.h). <macro> says which of the two is being built.
function(drape_library target macro)
  set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  get_target_property(type ${target} TYPE)
  if(NOT BUILD_SHARED_LIBS)
    target_compile_definitions(${target} PUBLIC DRAPE_STATIC)
  elseif(type STREQUAL "SHARED_LIBRARY")
    target_compile_definitions(${target} PRIVATE ${macro})
  else()
    target_compile_definitions(${target} PUBLIC ${macro})  # its users link what they would otherwise import
  endif()
endfunction()

# drape_static_twin(<target> <macro> [<objects>...]): makes <target>_static, which the project's own programs link: a
# shared library hides what tests and tools use of it. It is the library itself, or a static one of the same objects.
function(drape_static_twin target macro)
  set(twin ${target}_static)
  get_target_property(type ${target} TYPE)
  if(NOT type STREQUAL "SHARED_LIBRARY")
    add_library(${twin} ALIAS ${target})
    return()
  endif()
  add_library(${twin} STATIC EXCLUDE_FROM_ALL $<TARGET_OBJECTS:${target}> ${ARGN})
  set_target_properties(${twin} PROPERTIES LINKER_LANGUAGE CXX)
  get_target_property(libraries ${target} LINK_LIBRARIES)
  target_link_libraries(${twin} PUBLIC ${libraries})
  get_target_property(definitions ${target} INTERFACE_COMPILE_DEFINITIONS)
  target_compile_definitions(${twin} INTERFACE ${definitions} ${macro})
  get_target_property(folders ${target} INTERFACE_INCLUDE_DIRECTORIES)
  target_include_directories(${twin} INTERFACE ${folders})
endfunction()

# Names in namespace drape and of the C interface, with their tables and thunks.
set(DRAPE_EXPORTED_NAMES drape* _ZN5drape* _ZNK5drape* _ZT[ISV]N5drape* _ZTh*N5drape* _ZTv*N5drape*)

# drape_export_only(<target> <pattern>...): keeps symbols of other names out of a shared library's table, such as the
# standard library's templates, which are visible whatever this project's are. Patterns are the linker's.
function(drape_export_only target)
  if(NOT UNIX OR APPLE)
    return()
  endif()
  set(map ${CMAKE_CURRENT_BINARY_DIR}/${target}.map)
  list(JOIN ARGN "; " patterns)
  file(CONFIGURE OUTPUT ${map} CONTENT "{ global: ${patterns}; local: *; };\n" @ONLY)
  target_link_options(${target} PRIVATE LINKER:--version-script=${map})
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${map})
endfunction()

# drape_uses_opencl(<target>): for code that includes core/device headers. clhpp in Debian 12 compiles only when both of
# its version macros say 1.2. Nothing links OpenCL's loader.
function(drape_uses_opencl target)
  target_compile_definitions(${target} PRIVATE DRAPE_OPENCL=$<BOOL:${DRAPE_OPENCL}>)
  if(DRAPE_OPENCL)
    target_compile_definitions(${target} PRIVATE
      CL_TARGET_OPENCL_VERSION=120 CL_HPP_TARGET_OPENCL_VERSION=120 CL_HPP_MINIMUM_OPENCL_VERSION=120)
    target_include_directories(${target} SYSTEM PRIVATE ${DRAPE_OPENCL_INCLUDE_DIR} ${DRAPE_CLHPP_INCLUDE_DIR})
  endif()
endfunction()
