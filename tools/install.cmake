# The places where `cmake --install` puts files, and the Debian package that `cpack -G DEB` makes of it (tools/package
# does both).
include(GNUInstallDirs)

set(assets objectives tube_lenses illuminators elements glasses specimens stacks schemas)
list(TRANSFORM assets PREPEND ${PROJECT_SOURCE_DIR}/assets/)
# A build finds its assets as an installation does.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/share)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/assets ${PROJECT_BINARY_DIR}/share/vkfv SYMBOLIC)

install(TARGETS vkfv RUNTIME)
install(TARGETS vkfv_openimageio LIBRARY DESTINATION lib/vkfv)
install(DIRECTORY ${assets} DESTINATION ${CMAKE_INSTALL_DATADIR}/vkfv
        PATTERN "*-out" EXCLUDE)

# Debian's Python looks for packages here.
install(DIRECTORY tools/python/vkfv DESTINATION lib/python3/dist-packages PATTERN "__pycache__" EXCLUDE)

# The documents keep their places beside each other, so that their links hold.
install(FILES README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
file(GLOB pictures assets/*.png assets/*.svg)
install(FILES ${pictures} DESTINATION ${CMAKE_INSTALL_DOCDIR}/assets)

# The program itself tells its manual and completions, when it is installed.
set(told ${PROJECT_BINARY_DIR}/told)
install(CODE "
  file(MAKE_DIRECTORY ${told})
  function(tell file)
    execute_process(COMMAND $<TARGET_FILE:vkfv> \${ARGN} OUTPUT_FILE ${told}/\${file} COMMAND_ERROR_IS_FATAL ANY)
  endfunction()
  tell(vkfv.1 man)
  tell(vkfv completion bash)
  tell(_vkfv completion zsh)
  tell(vkfv.fish completion fish)
  file(ARCHIVE_CREATE OUTPUT ${told}/vkfv.1.gz PATHS ${told}/vkfv.1 FORMAT raw COMPRESSION GZip)
")
install(FILES ${told}/vkfv.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${told}/vkfv DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${told}/_vkfv DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${told}/vkfv.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

set(CPACK_PACKAGE_NAME vkfv)
set(CPACK_PACKAGE_VENDOR "vkfv maintainers")
set(CPACK_PACKAGE_CONTACT "vkfv maintainers <maintainers@vkfv.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "virtual focus-variation microscope")
set(CPACK_PACKAGE_DESCRIPTION "Traces light through real lens prescriptions to a specimen and back to a detector, for every
focal position of a scan, and finds the topography in the images. Needs a Vulkan driver: that of a GPU, or Mesa's for the
processor (mesa-vulkan-drivers).")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "mesa-vulkan-drivers | nvidia-driver-libs, fonts-dejavu-core")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3-numpy, python3-tifffile") # the Python package imports them
include(CPack)
