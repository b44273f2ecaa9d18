# What `cmake --install` installs, and the Debian package that `cpack` makes of it:
#   cpack --config build/release/CPackConfig.cmake -B build/package
include(GNUInstallDirs)

install(TARGETS semigeo RUNTIME)
# What man and shells look for; the program makes it when it is built.
set(system ${PROJECT_BINARY_DIR}/system)
install(DIRECTORY ${system}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR})
install(FILES ${system}/semigeo.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  RENAME semigeo)
install(FILES ${system}/_semigeo DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
# Debian's zsh looks here for what comes from packages.
install(FILES ${system}/_semigeo DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${system}/semigeo.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(FILES CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
# Pages refer to each other and to figures by their places in the repository.
file(GLOB_RECURSE pages CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
  *.md docs/figures/* bench/*.svg bench/*.png)
list(FILTER pages EXCLUDE REGEX "^(build|demo|tests/fixtures)/")
foreach(page ${pages})
  cmake_path(GET page PARENT_PATH folder)
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME semigeo)
set(CPACK_PACKAGE_VENDOR "The semigeo developers")
set(CPACK_PACKAGE_CONTACT "The semigeo developers <semigeo@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION
  "semigeo turns archives of 3-D scans into multi-scale HDF5 datasets of their surfaces and
curvatures, builds geometric-hash libraries over them, and recognises objects in new scans.")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
include(CPack)
