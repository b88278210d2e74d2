# Run by EmbedWeb.cmake while building: web/ → ${BUILD}/web_assets.cpp. Arguments: SOURCE, BUILD, MISSING, NODE, NPM.

include(${CMAKE_CURRENT_LIST_DIR}/NpmCi.cmake)

# The dashboard, and in one script and one style the page of `chicane report`.
function(build_pages)
  execute_process(COMMAND ${NODE} build.mjs ${BUILD}/dist ${BUILD}/document WORKING_DIRECTORY ${SOURCE}
                  RESULT_VARIABLE failed)
  file(GLOB scripts ${BUILD}/document/assets/*.js)
  file(GLOB styles ${BUILD}/document/assets/*.css)
  list(LENGTH scripts script_count)
  list(LENGTH styles style_count)
  if(failed OR NOT script_count EQUAL 1 OR NOT style_count EQUAL 1)
    message(FATAL_ERROR "Vite could not build the pages in ${SOURCE}: expected one script and one style of the document")
  endif()
  set(script ${scripts} PARENT_SCOPE)
  set(style ${styles} PARENT_SCOPE)
endfunction()

# C++ that defines constexpr array `name` with the compressed bytes of a file.
function(compressed_array name file result)
  file(ARCHIVE_CREATE OUTPUT ${BUILD}/file.gz PATHS ${file} FORMAT raw COMPRESSION GZip COMPRESSION_LEVEL 9)
  file(READ ${BUILD}/file.gz hex HEX)
  file(REMOVE ${BUILD}/file.gz)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
  string(REPEAT "." 100 line)
  string(REGEX REPLACE "(${line})" "\\1\n    " bytes "${bytes}")
  set(${result} "constexpr unsigned char ${name}[] = {\n    ${bytes}};\n" PARENT_SCOPE)
endfunction()

function(write_plain_page)
  file(REMOVE_RECURSE ${BUILD}/dist)
  file(WRITE ${BUILD}/dist/index.html "<!doctype html>
<html lang=\"en\">
<meta charset=\"utf-8\">
<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">
<title>chicane</title>
<link rel=\"icon\" href=\"data:,\">
<style>body{font:16px/1.5 system-ui,sans-serif;max-width:40em;margin:4em auto;padding:0 1em;color-scheme:light dark}</style>
<main>
<h1>chicane is running, without its dashboard</h1>
<p>The dashboard is not part of this program: ${MISSING}.</p>
<p>Install Node.js 18.18 or newer with npm and build again. Meanwhile Foxglove and Lichtblick can connect to this
address with the Foxglove WebSocket protocol.</p>
</main>
</html>
")
endfunction()

function(content_type file result)
  get_filename_component(extension ${file} LAST_EXT)
  set(.html "text/html; charset=utf-8")
  set(.js "text/javascript; charset=utf-8")
  set(.css "text/css; charset=utf-8")
  set(.svg "image/svg+xml")
  set(.png "image/png")
  set(.json "application/json")
  if(NOT DEFINED ${extension})
    message(FATAL_ERROR "${file}: no content type for *${extension}; add it to EmbedWebFiles.cmake")
  endif()
  set(${result} "${${extension}}" PARENT_SCOPE)
endfunction()

function(write_source)
  file(GLOB_RECURSE files RELATIVE ${BUILD}/dist ${BUILD}/dist/*)
  set(arrays "")
  set(table "")
  set(index 0)
  foreach(file ${files})
    content_type(${file} type)
    compressed_array(kFile${index} ${BUILD}/dist/${file} array)
    string(APPEND arrays "${array}")
    string(APPEND table "      {\"/${file}\", \"${type}\", view(kFile${index}), true},\n")
    math(EXPR index "${index} + 1")
  endforeach()
  set(views "")
  if(script)
    compressed_array(kDocumentScript ${script} script_array)
    compressed_array(kDocumentStyle ${style} style_array)
    string(APPEND arrays "${script_array}${style_array}")
    set(views "view(kDocumentScript), view(kDocumentStyle)")
  endif()
  file(WRITE ${BUILD}/web_assets.cpp "// Generated from web/ by cmake/EmbedWebFiles.cmake: do not edit.
#include \"chicane/live/pages.hpp\"

namespace chicane::live {
namespace {

${arrays}
template <std::size_t N>
std::string_view view(const unsigned char (&bytes)[N]) {
  return {reinterpret_cast<const char*>(bytes), N};
}

}  // namespace

std::vector<net::Asset> embedded_assets() {
  return {
${table}  };
}

recording::ReportBundle document_bundle() { return {${views}}; }

}  // namespace chicane::live
")
endfunction()

if(NOT MISSING)
  npm_ci(${SOURCE} ${NPM} failed)
  if(failed)
    set(MISSING "`npm ci` failed when this program was built (is the npm registry reachable?)")
  endif()
endif()
if(MISSING)
  message(WARNING "No dashboard: ${MISSING}. To try again, remove ${BUILD}/web_assets.cpp and build.")
  write_plain_page()
else()
  build_pages()
endif()
write_source()
