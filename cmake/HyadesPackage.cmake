# Installation (cmake --install) and the Debian package (cpack, in the build folder). The programs lie together in
# libexec, where `hyades` finds its fellows; bin/ holds a link to it.
install(TARGETS hyades hyades-render hyades-film RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/hyades)
if(HYADES_FARM)
  install(TARGETS hyades-client hyades-coordinator hyades-worker hyades-worker-render RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/hyades)
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
set(CPACK_STRIP_FILES ON)
include(CPack)
