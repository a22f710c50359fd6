# Run by CPack between staging and packing: manual pages and changelogs are compressed, as Debian has them. The names in the
# headers of .gz files are left out, so that equal builds give equal packages.
file(GLOB_RECURSE files "${CPACK_TEMPORARY_DIRECTORY}/*.1" "${CPACK_TEMPORARY_DIRECTORY}/changelog.Debian")
execute_process(COMMAND gzip --best --no-name --force ${files} COMMAND_ERROR_IS_FATAL ANY)
