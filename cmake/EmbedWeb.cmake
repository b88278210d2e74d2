# The dashboard as one generated source file: target chicane_web_assets, header chicane/live/pages.hpp.
#
#   include(EmbedWeb)
#   target_link_libraries(my_program PRIVATE chicane_web_assets)
#
# With CHICANE_WEB and Node 18 or newer, building the target runs `npm ci` (only when web/package-lock.json has changed) and
# Vite. Without them the program builds all the same, and its page says what is missing.
include_guard(GLOBAL)

set(web_source ${PROJECT_SOURCE_DIR}/web)
set(web_build ${PROJECT_BINARY_DIR}/web)
set(web_missing "")
if(NOT CHICANE_WEB)
  set(web_missing "this program was configured with CHICANE_WEB=OFF")
else()
  find_program(CHICANE_NODE NAMES node nodejs)
  find_program(CHICANE_NPM npm)
  mark_as_advanced(CHICANE_NODE CHICANE_NPM)
  if(NOT CHICANE_NODE OR NOT CHICANE_NPM)
    set(web_missing "Node.js and npm were not found when this program was built")
  else()
    execute_process(COMMAND ${CHICANE_NODE} --version OUTPUT_VARIABLE node_version OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(REPLACE "v" "" node_version "${node_version}")
    if(node_version VERSION_LESS 18.18)
      set(web_missing "this program was built with Node.js ${node_version}, and the dashboard needs 18.18 or newer")
    endif()
  endif()
endif()
set(CHICANE_WEB_MISSING "${web_missing}" CACHE INTERNAL "why the program has no dashboard; empty when it has one")
if(web_missing)
  message(STATUS "No dashboard: ${web_missing}")
endif()

file(GLOB_RECURSE web_files CONFIGURE_DEPENDS ${web_source}/src/* ${web_source}/public/*)
add_custom_command(
  OUTPUT ${web_build}/web_assets.cpp
  COMMAND ${PROJECT_SOURCE_DIR}/tools/note_time.sh -o web/web_assets.cpp
          ${CMAKE_COMMAND} -DSOURCE=${web_source} -DBUILD=${web_build} "-DMISSING=${web_missing}" -DNODE=${CHICANE_NODE}
          -DNPM=${CHICANE_NPM} -P ${CMAKE_CURRENT_LIST_DIR}/EmbedWebFiles.cmake
  DEPENDS ${CMAKE_CURRENT_LIST_DIR}/EmbedWebFiles.cmake ${CMAKE_CURRENT_LIST_DIR}/NpmCi.cmake ${web_files} ${web_source}/index.html ${web_source}/document.html ${web_source}/style.css
          ${web_source}/build.mjs ${web_source}/package.json ${web_source}/package-lock.json ${web_source}/vite.config.ts
          ${web_source}/tsconfig.json
  WORKING_DIRECTORY ${CMAKE_BINARY_DIR}
  COMMENT "Building and embedding the dashboard"
  VERBATIM)
add_library(chicane_web_assets STATIC ${web_build}/web_assets.cpp)
target_link_libraries(chicane_web_assets PUBLIC chicane_net PRIVATE chicane_options)
