# Copies the dashboard, adds a panel and a signal as CONTRIBUTING.md says, and builds it: the panel's own file and its row; the
# signal's row in frame_fields.cpp, from which `renew_fixtures` writes messages.ts. Arguments: SOURCE, COPY, NODE, TYPES (messages.ts as
# one_more_field_test writes it).
function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${COPY} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(code)
    message(FATAL_ERROR "${ARGN}: exit code ${code}\n${out}")
  endif()
endfunction()

function(insert file after line)
  file(READ ${file} text)
  string(REPLACE "${after}" "${after}${line}" changed "${text}")
  if(changed STREQUAL text)
    message(FATAL_ERROR "${file}: expected in it: ${after}")
  endif()
  file(WRITE ${file} "${changed}")
endfunction()

file(REMOVE_RECURSE ${COPY})
file(COPY ${SOURCE}/web/ DESTINATION ${COPY} PATTERN node_modules EXCLUDE)
file(CREATE_LINK ${SOURCE}/web/node_modules ${COPY}/node_modules SYMBOLIC)
file(COPY ${CMAKE_CURRENT_LIST_DIR}/added_panel/ DESTINATION ${COPY}/src/views)
insert(${COPY}/src/views/workbench_view.tsx "import { FaultsView } from './faults_view';\n"
       "import { HalfPaceView } from './half_pace_view';\n")
insert(${COPY}/src/views/workbench_view.tsx "  { name: 'faults', title: 'Faults', View: FaultsView },\n"
       "  { name: 'half', title: 'Half the pace', View: HalfPaceView },\n")
file(COPY_FILE ${TYPES} ${COPY}/src/protocol/messages.ts)

run(${NODE} node_modules/typescript/bin/tsc --noEmit)
run(${NODE} node_modules/vite/bin/vite.js build --outDir dist --logLevel warn)
file(GLOB scripts ${COPY}/dist/assets/*.js)
foreach(script ${scripts})
  file(READ ${script} text)
  string(APPEND all "${text}")
endforeach()
foreach(words "Half the pace" "half of the pace" "half_pace")
  string(FIND "${all}" "${words}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "the dashboard was built without \"${words}\"")
  endif()
endforeach()
