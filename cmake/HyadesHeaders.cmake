# Headers that nearly every file reads are compiled once: reading them again for each file was half of a build.
# Files include what they use all the same, and HYADES_PCH=OFF compiles them without.
option(HYADES_PCH "Compile common headers once" ON)

# hyades_header_set(SET [AND set] [USES libraries...] [OPTIONS compiler options...] HEADERS headers...): a set of headers,
# those of another one among them. Whoever reads it compiled must be compiled with the same options.
function(hyades_header_set set)
  cmake_parse_arguments(SET "" "AND" "USES;OPTIONS;HEADERS" ${ARGN})
  if(NOT HYADES_PCH)
    return()
  endif()
  if(SET_AND)
    get_property(more GLOBAL PROPERTY hyades_headers_${SET_AND})
    list(PREPEND SET_HEADERS ${more})
  endif()
  set_property(GLOBAL PROPERTY hyades_headers_${set} ${SET_HEADERS})
  set(empty ${CMAKE_CURRENT_BINARY_DIR}/headers_${set}.cpp)
  file(CONFIGURE OUTPUT ${empty} CONTENT "")
  add_library(hyades_headers_${set} STATIC EXCLUDE_FROM_ALL ${empty})
  target_link_libraries(hyades_headers_${set} PRIVATE ${SET_USES})
  target_include_directories(hyades_headers_${set} PRIVATE ${CMAKE_SOURCE_DIR})
  target_compile_options(hyades_headers_${set} PRIVATE ${SET_OPTIONS})
  target_precompile_headers(hyades_headers_${set} PRIVATE ${SET_HEADERS})
endfunction()

# hyades_headers(TARGET SET): TARGET's files begin with the headers of SET.
function(hyades_headers target set)
  if(HYADES_PCH)
    target_precompile_headers(${target} REUSE_FROM hyades_headers_${set})
  endif()
endfunction()
