# How every file is compiled. The floating-point flags are part of the promise of equal bits:
# no contraction, no fast-math, one -march for the whole build.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
add_link_options(-Wl,--as-needed)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")

add_compile_options(-pthread -march=${HYADES_ARCH} -ffp-contract=off -fno-math-errno
                    -Wall -Wextra -Wpedantic -Wnon-virtual-dtor -Woverloaded-virtual)
# GCC sees copies reach past the ends of strings and one-element vectors that do not (its bugs 105651 and 56456); 12
# also overlapping ones.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread)
  if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    add_compile_options(-Wno-restrict)
  endif()
endif()
if(HYADES_WERROR)
  add_compile_options(-Werror)
endif()

if(HYADES_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
if(HYADES_SANITIZE)
  add_compile_options(-fsanitize=${HYADES_SANITIZE} -fno-omit-frame-pointer
                      -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${HYADES_SANITIZE})
endif()

# A first build that compiles files by the dozen takes less than half of the time; where one line is changed again and
# again, each by itself is faster. So that both work, names in the unnamed namespaces of one room differ.
option(HYADES_UNITY "Compile several files of a room at once" OFF)
set(CMAKE_UNITY_BUILD ${HYADES_UNITY})
if(NOT DEFINED CMAKE_UNITY_BUILD_BATCH_SIZE)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 12)
endif()
if(NOT HYADES_UNITY)
  add_compile_options(-Wshadow)
elseif(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-Wshadow=local)  # what is global may be so in another file
endif()

find_program(HYADES_CCACHE ccache)
if(HYADES_CCACHE)
  # Where its folder cannot be written (a read-only home), ccache fails instead of compiling.
  file(WRITE ${CMAKE_BINARY_DIR}/CMakeFiles/ccache_works.cpp "int main() { return 0; }\n")
  execute_process(COMMAND ${HYADES_CCACHE} ${CMAKE_CXX_COMPILER} -c ccache_works.cpp -o ccache_works.o
                  WORKING_DIRECTORY ${CMAKE_BINARY_DIR}/CMakeFiles
                  RESULT_VARIABLE ccache_status OUTPUT_QUIET ERROR_QUIET)
  if(ccache_status EQUAL 0)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${HYADES_CCACHE})
  else()
    message(STATUS "ccache is here but does not work: built without it")
  endif()
endif()
find_program(HYADES_MOLD mold)
if(HYADES_MOLD)
  add_link_options(-fuse-ld=mold)
endif()
