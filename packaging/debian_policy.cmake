# Run by cpack on the files of a Debian package before they are packed: what Debian's policy asks of a
# package and `cmake --install` does not do.
set(documents ${CPACK_TEMPORARY_DIRECTORY}/usr/share/doc/mortier)
file(COPY_FILE ${CPACK_MORTIER_PACKAGING}/copyright ${documents}/copyright)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC) # of SOURCE_DATE_EPOCH where that is set
file(WRITE ${documents}/changelog "mortier (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * What changed is in CHANGELOG.md of the sources.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
file(GLOB pages ${CPACK_TEMPORARY_DIRECTORY}/usr/share/man/man1/*.1)
execute_process(COMMAND gzip -9n ${documents}/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)

# The packages of the libraries that programs and modules are linked with; CPack's own search starts two
# processes for every file of the package.
file(GLOB_RECURSE linked ${CPACK_TEMPORARY_DIRECTORY}/usr/bin/* ${CPACK_TEMPORARY_DIRECTORY}/usr/*.so)
file(WRITE ${CPACK_TEMPORARY_DIRECTORY}/debian/control "")
execute_process(COMMAND dpkg-shlibdeps --ignore-missing-info -O ${linked}
                WORKING_DIRECTORY ${CPACK_TEMPORARY_DIRECTORY} OUTPUT_VARIABLE depends
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE_RECURSE ${CPACK_TEMPORARY_DIRECTORY}/debian)
string(REGEX REPLACE "^.*Depends=" "" CPACK_DEBIAN_PACKAGE_DEPENDS "${depends}")
