# Run by CPack between staging and packing: compresses manual pages and changelogs, as Debian does. The names in the headers of
# .gz files are omitted, so that equal builds give equal packages.
file(GLOB_RECURSE files "${CPACK_TEMPORARY_DIRECTORY}/*.1" "${CPACK_TEMPORARY_DIRECTORY}/changelog.Debian")
execute_process(COMMAND gzip --best --no-name --force ${files} COMMAND_ERROR_IS_FATAL ANY)
