# Man pages by help2man, where it is there: the target `man`, part of `all` and of the installation. They follow from what the
# commands say, so from the sources of the program alone.
find_program(HELP2MAN help2man)
if(HELP2MAN AND NOT CDEM_SANITIZE AND NOT CMAKE_CROSSCOMPILING)
  file(GLOB program_sources CONFIGURE_DEPENDS tools/*.c tools/*.def)
  add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/man/cdem.1.gz
    COMMAND sh ${PROJECT_SOURCE_DIR}/cmake/man.sh $<TARGET_FILE:cdem_program> ${PROJECT_SOURCE_DIR} ${PROJECT_VERSION} ${CMAKE_BINARY_DIR}/man
    DEPENDS ${program_sources} cmake/man.sh COMMENT "Writing man pages" VERBATIM)
  add_custom_target(man ALL DEPENDS ${CMAKE_BINARY_DIR}/man/cdem.1.gz)
  add_dependencies(man cdem_program)
  install(DIRECTORY ${CMAKE_BINARY_DIR}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 FILES_MATCHING PATTERN "*.1.gz")
endif()
