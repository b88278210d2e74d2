# Writes a copy of the table of frame fields with one row more: cmake -DTABLE=frame_fields.cpp -DCOPY=copy.cpp -P one_more_field.cmake
file(READ ${TABLE} table)
set(group "constexpr std::array kSolver{\n")
set(row "    field<double>(\"half_pace\", \"for a test\", [](const Frame& f) { return 0.5 * f.pace; }),\n")
string(REPLACE "${group}" "${group}${row}" copy "${table}")
if(copy STREQUAL table)
  message(FATAL_ERROR "${TABLE}: expected a group that begins with ${group}")
endif()
file(WRITE ${COPY} "${copy}")
