# cdem_room(NAME file.c ...): one room = one folder = one object library with the project's flags.
set(CDEM_FLAGS -Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla
               -Wpointer-arith -Wwrite-strings -fno-math-errno -fno-trapping-math)
if(CDEM_WERROR)
  list(APPEND CDEM_FLAGS -Werror)
endif()
if(CDEM_SANITIZE)
  # Function multiversioning resolves before the sanitizer's run time is up, so the fast kernels
  # are built once, for the baseline processor.
  add_compile_options(-fsanitize=${CDEM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${CDEM_SANITIZE})
  add_compile_definitions(CDEM_NO_MULTIVERSION)
endif()
if(CDEM_COVERAGE)
  # Counts of lines are kept for one version of each kernel, the baseline; threads add to them atomically.
  add_compile_definitions(CDEM_NO_MULTIVERSION)
  add_link_options(--coverage)
endif()
add_compile_definitions(_GNU_SOURCE CDEM_VERSION="${PROJECT_VERSION}")

set(CDEM_ROOM_TARGETS "" CACHE INTERNAL "")
function(cdem_room name)
  add_library(cdem_${name} OBJECT ${ARGN})
  target_compile_options(cdem_${name} PRIVATE ${CDEM_FLAGS})
  if(CDEM_COVERAGE)
    target_compile_options(cdem_${name} PRIVATE --coverage -fprofile-update=atomic)
  endif()
  target_include_directories(cdem_${name} PUBLIC ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(cdem_${name} PUBLIC ${CDEM_LINK_LIBRARIES})
  set_target_properties(cdem_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  set(CDEM_ROOM_TARGETS "${CDEM_ROOM_TARGETS};cdem_${name}" CACHE INTERNAL "")
endfunction()
