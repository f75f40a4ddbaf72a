# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Run by cpack over the files of a package: what Debian wants of documents, and where.

if(NOT CPACK_GENERATOR STREQUAL "DEB")
  return()
endif()
set(share ${CPACK_TEMPORARY_DIRECTORY}/usr/share)
set(folder ${share}/doc/${CPACK_DEBIAN_PACKAGE_NAME})
file(MAKE_DIRECTORY ${folder})
file(RENAME ${share}/licenses/duet/LICENSE ${folder}/copyright)
file(REMOVE_RECURSE ${share}/licenses)

# The day is that of the release, whenever the package is built.
set(version ${CPACK_PACKAGE_VERSION})
file(READ ${CPACK_duet_CHANGELOG} text)
if(NOT text MATCHES "\n## \\[${version}\\] - ([0-9-]+)\n")
  message(FATAL_ERROR "duet: CHANGELOG.md has no line '## [${version}] - <day>'")
endif()
execute_process(COMMAND date --utc --rfc-email --date=${CMAKE_MATCH_1} OUTPUT_VARIABLE day
  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${folder}/changelog.Debian "${CPACK_DEBIAN_PACKAGE_NAME} (${version}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium

  * Release ${version}; what is new is told in changelog.gz.

 -- ${CPACK_PACKAGE_CONTACT}  ${day}
")
file(COPY_FILE ${CPACK_duet_CHANGELOG} ${folder}/changelog)
execute_process(COMMAND gzip -9n ${folder}/changelog ${folder}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
