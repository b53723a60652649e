# drape_target(<target>): how every target of this project is compiled. Nothing of it reaches a user of Drape::drape.
#
# Floating-point contraction is off everywhere: the host must round as the devices do, or contacts differ in their bits.
function(drape_target target)
  target_compile_features(${target} PRIVATE cxx_std_17)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/bullet_plugin/include)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -ffp-contract=off)
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
