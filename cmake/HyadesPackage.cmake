# Installation (cmake --install) and the Debian package (cpack, in the build folder). The programs lie together in
# libexec, where `hyades` finds its fellows; bin/ holds a link to it.
install(TARGETS hyades hyades-render hyades-film RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/hyades)
if(HYADES_FARM)
  install(TARGETS hyades-backup hyades-client hyades-coordinator hyades-worker hyades-worker-render RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/hyades)
endif()
install(CODE "
  set(bin \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}\")
  file(MAKE_DIRECTORY \"\${bin}\")
  file(CREATE_LINK \"../${CMAKE_INSTALL_LIBEXECDIR}/hyades/hyades\" \"\${bin}/hyades\" SYMBOLIC)")
# Man pages and completions are made of what the programs say of themselves.
install(CODE "
  set(manuals \"${CMAKE_BINARY_DIR}/manuals\")
  file(REMOVE_RECURSE \"\${manuals}\")
  execute_process(COMMAND \"${CMAKE_SOURCE_DIR}/deploy/make_manuals\" \"${CMAKE_RUNTIME_OUTPUT_DIRECTORY}\" \"\${manuals}\" RESULT_VARIABLE failed)
  if(failed)
    message(WARNING \"installed without manual pages and completions\")
  else()
    set(share \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}\")
    file(INSTALL \"\${manuals}/man1\" DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}\")
    file(INSTALL \"\${manuals}/completions/hyades\" DESTINATION \"\${share}/bash-completion/completions\")
    file(INSTALL \"\${manuals}/completions/_hyades\" DESTINATION \"\${share}/zsh/vendor-completions\")
    file(INSTALL \"\${manuals}/completions/hyades.fish\" DESTINATION \"\${share}/fish/vendor_completions.d\")
  endif()")
# Services and their options: of a system (prefix /usr), where their users and folders come with the package.
if(HYADES_FARM)
  install(CODE "
    if(CMAKE_INSTALL_PREFIX MATCHES \"/usr$\")
      file(INSTALL \"${CMAKE_SOURCE_DIR}/deploy/systemd/\" DESTINATION \"\${CMAKE_INSTALL_PREFIX}/lib/systemd/system\"
           FILES_MATCHING PATTERN \"*.service\")
      file(INSTALL \"${CMAKE_SOURCE_DIR}/deploy/systemd/80-hyades.preset\" DESTINATION \"\${CMAKE_INSTALL_PREFIX}/lib/systemd/system-preset\")
      get_filename_component(system \"\${CMAKE_INSTALL_PREFIX}\" DIRECTORY)
      string(REGEX REPLACE \"/$\" \"\" system \"\${system}\")
      file(INSTALL \"${CMAKE_SOURCE_DIR}/deploy/systemd/\" DESTINATION \"\${system}/etc/hyades\"
           FILES_MATCHING PATTERN \"*.yaml\")
    endif()")
endif()
# The package for Python, where Debian's looks for it.
install(DIRECTORY python/hyades DESTINATION lib/python3/dist-packages FILES_MATCHING PATTERN "*.py" PATTERN py.typed
        PATTERN __pycache__ EXCLUDE PATTERN .mypy_cache EXCLUDE)
# The add-on for Blender: its zip for people, and unpacked for `hyades render file.blend`.
find_program(HYADES_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(HYADES_PYTHON python3)
install(CODE "
  set(blender \"${CMAKE_BINARY_DIR}/blender\")
  file(REMOVE_RECURSE \"\${blender}\")
  foreach(how \"\" --unpacked)
    execute_process(COMMAND \"${HYADES_PYTHON}\" \"${CMAKE_SOURCE_DIR}/blender/make_zip\" \${how} \"\${blender}\"
                    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
  file(INSTALL \"\${blender}\" DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/hyades\")")
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY jobs/ DESTINATION ${CMAKE_INSTALL_DATADIR}/hyades/jobs
        PATTERN generator EXCLUDE PATTERN CMakeLists.txt EXCLUDE)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_NAME hyades)
set(CPACK_PACKAGE_CONTACT "The Hyades maintainers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${CPACK_PACKAGE_CONTACT}")
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # exact dependencies, read off the programs
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS ffmpeg)  # for videos
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3 (>= 3.11), python3-numpy, blender (>= 3.4)")  # for the package hyades; for .blend
set(CPACK_STRIP_FILES ON)
if(HYADES_FARM)
  # preinst knows which stores these programs can read: one version for each step of the schema.
  file(READ ${CMAKE_SOURCE_DIR}/coordinator/job_store/schema.cpp schema)
  set_property(DIRECTORY ${CMAKE_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/coordinator/job_store/schema.cpp)
  string(REGEX MATCHALL "R\"\\(" steps "${schema}")
  list(LENGTH steps HYADES_SCHEMA_VERSION)
  set(control ${CMAKE_SOURCE_DIR}/deploy/debian)
  configure_file(${control}/preinst.in ${CMAKE_BINARY_DIR}/debian/preinst @ONLY)
  set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/debian/preinst ${control}/postinst ${control}/prerm ${control}/postrm
      ${control}/conffiles)
endif()
include(CPack)
