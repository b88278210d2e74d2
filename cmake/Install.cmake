# find_package(chicane COMPONENTS ...) and pkg-config for users of the library: each module is a component with its own exported targets
# and its own chicane-MODULE.pc, both made from what its target links. tests/install builds consumers of each kind.
# Components: program, dev, doc, and plain, what a package has in another form (Package.cmake).
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME dev)
get_property(modules GLOBAL PROPERTY CHICANE_MODULES)

# chicane::lib is all of it.
add_library(chicane_lib INTERFACE)
add_library(chicane::lib ALIAS chicane_lib)
set_target_properties(chicane_lib PROPERTIES EXPORT_NAME lib)
target_link_libraries(chicane_lib INTERFACE ${modules})

# What the static libraries need from the system, as far as this build uses it: target, name for find_package() and for pkg-config, package of
# Debian (Package.cmake).
foreach(row IN ITEMS
    tl::expected,tl-expected,,libexpected-dev
    Threads::Threads,Threads,,
    fmt::fmt,fmt,fmt,libfmt-dev
    NLopt::nlopt,NLopt,nlopt,libnlopt-dev
    yaml-cpp,yaml-cpp,yaml-cpp,libyaml-cpp-dev
    PNG::PNG,PNG,libpng,libpng-dev
    pugixml::pugixml,pugixml,pugixml,libpugixml-dev
    SQLite::SQLite3,SQLite3,sqlite3,libsqlite3-dev
    zstd::libzstd_shared,zstd,libzstd,libzstd-dev)
  string(REPLACE "," ";" row "${row}")
  list(POP_FRONT row need package_of_need requires_of_need deb_of_need)
  foreach(kind package_of requires_of deb_of)
    set(${kind}_${need} "${${kind}_need}")
  endforeach()
endforeach()
set(pc_libs_of_Threads::Threads "-pthread")

# Headers that only our own sources include: of no concern to users. As a public link they are.
set(built_with Boost::headers Boost::boost nlohmann_json::nlohmann_json Eigen3::Eigen)

set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/chicane)
set(pc_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
# The prefix in a .pc file is relative to the file, so that an installation can be moved.
file(RELATIVE_PATH pc_to_prefix /prefix/${pc_dir} /prefix)
string(REGEX REPLACE "/$" "" pc_to_prefix "${pc_to_prefix}")
set(pc_instruction_sets "")
set(pc_instruction_set_names "")
list(JOIN CHICANE_FLAGS_FLOAT " " pc_float_flags)
foreach(set IN LISTS CHICANE_INSTRUCTION_SETS)
  string(TOLOWER ${set} name)
  list(JOIN CHICANE_FLAGS_${set} " " flags)
  string(APPEND pc_instruction_set_names " ${name}")
  string(APPEND pc_instruction_sets "cflags_${name}=-DCHICANE_ARCH=${set} ${flags}\n")
endforeach()

# What a target links: uses_of_TARGET, modules of ours with all that they use, and needs_of_TARGET, what others provide.
function(read_links target)
  get_target_property(links ${target} INTERFACE_LINK_LIBRARIES)
  foreach(header_only IN LISTS built_with)
    list(REMOVE_ITEM links "$<LINK_ONLY:${header_only}>")
  endforeach()
  set_target_properties(${target} PROPERTIES INTERFACE_LINK_LIBRARIES "${links}")
  string(REGEX REPLACE "\\$<LINK_ONLY:([^>]*)>" "\\1" links "${links}")
  set(uses "")
  set(needs "")
  foreach(link IN LISTS links)
    if(link MATCHES "^chicane_" AND TARGET ${link})
      list(APPEND uses ${link} ${uses_of_${link}})
    elseif(DEFINED package_of_${link})
      list(APPEND needs ${link})
    elseif(NOT link MATCHES "BUILD_INTERFACE")
      message(FATAL_ERROR "cmake/Install.cmake: ${target} links ${link}: add the package that provides it")
    endif()
  endforeach()
  list(REMOVE_DUPLICATES uses)
  list(REMOVE_DUPLICATES needs)
  set(uses_of_${target} "${uses}" PARENT_SCOPE)
  set(needs_of_${target} "${needs}" PARENT_SCOPE)
endfunction()

# The .pc file of a module: its archive and those of the modules it uses, users before what they use, and the packages they need.
function(write_pc target pc_name)
  set(archives "")
  set(requires "")
  set(libs "")
  set(pc_definitions "")
  foreach(set IN LISTS CHICANE_LEFT_OUT)
    string(TOUPPER ${set} name)
    string(APPEND pc_definitions " -DCHICANE_WITHOUT_${name}")
  endforeach()
  if(target STREQUAL "chicane_protocol" OR "chicane_protocol" IN_LIST uses_of_${target})
    string(APPEND pc_definitions " -DCHICANE_USES_INSTALLATION")  # protocol/data_folders.hpp
  endif()
  foreach(module IN LISTS modules)  # in the order of the layers
    if(module STREQUAL target OR module IN_LIST uses_of_${target})
      get_target_property(type ${module} TYPE)
      if(NOT type STREQUAL INTERFACE_LIBRARY)
        list(PREPEND archives "-l${module}")
      endif()
      foreach(need IN LISTS needs_of_${module})
        list(APPEND requires ${requires_of_${need}})
        list(APPEND libs ${pc_libs_of_${need}})
      endforeach()
    endif()
  endforeach()
  list(REMOVE_DUPLICATES requires)
  list(REMOVE_DUPLICATES libs)
  list(JOIN archives " " pc_archives)
  list(JOIN requires " " pc_requires)
  list(JOIN libs " " pc_libs)
  configure_file(cmake/chicane.pc.in ${pc_name}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${pc_name}.pc DESTINATION ${pc_dir})
endfunction()

set(components "")
set(component_facts "")
foreach(target IN LISTS modules ITEMS chicane_lib)
  read_links(${target})
  string(REGEX REPLACE "^chicane_" "" name ${target})
  string(APPEND components " ${name}")
  string(APPEND component_facts "set(chicane_uses_of_${name}")
  foreach(used IN LISTS uses_of_${target})
    string(REGEX REPLACE "^chicane_" " " used ${used})
    string(APPEND component_facts ${used})
  endforeach()
  string(APPEND component_facts ")\nset(chicane_packages_of_${name}")
  foreach(need IN LISTS needs_of_${target})
    string(APPEND component_facts " \"${package_of_${need}}\"")
  endforeach()
  string(APPEND component_facts ")\n")
  install(TARGETS ${target} EXPORT chicane_${name} FILE_SET HEADERS)
  install(EXPORT chicane_${name} NAMESPACE chicane:: DESTINATION ${config_dir})
  if(target STREQUAL chicane_lib)
    set(pc_description "${PROJECT_DESCRIPTION}")
    write_pc(${target} chicane)
  else()
    set(pc_description "Module ${name} of chicane")
    write_pc(${target} chicane-${name})
  endif()
endforeach()

set(data_dir ${CMAKE_INSTALL_DATADIR}/chicane)
configure_package_config_file(cmake/chicaneConfig.cmake.in chicaneConfig.cmake INSTALL_DESTINATION ${config_dir} PATH_VARS data_dir)
write_basic_package_version_file(chicaneConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/chicaneConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/chicaneConfigVersion.cmake
        cmake/InstructionSets.cmake tools/check_symbols.py tools/usage.py DESTINATION ${config_dir})

# What the program finds by name, and views for others' viewers. Programs in the build tree find the files by links that lie where
# an installed program looks or one folder further up (protocol/data_folders.hpp): no binary knows the source tree.
if(TARGET chicane_protocol)
  install(DIRECTORY data/ studies/plans studies/leagues studies/claims DESTINATION ${data_dir} COMPONENT program)
  install(DIRECTORY studies/jobs DESTINATION ${data_dir} USE_SOURCE_PERMISSIONS COMPONENT program)
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/chicane)
  foreach(folder presets cars tracks scenarios)
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/data/${folder} ${CMAKE_BINARY_DIR}/share/chicane/${folder} SYMBOLIC)
  endforeach()
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT plain)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc)
