# find_package(chicane) and pkg-config for users of the library; tests/install builds a consumer of each.
include(CMakePackageConfigHelpers)
get_property(modules GLOBAL PROPERTY CHICANE_MODULES)

# chicane::lib is all of it.
add_library(chicane_lib INTERFACE)
add_library(chicane::lib ALIAS chicane_lib)
set_target_properties(chicane_lib PROPERTIES EXPORT_NAME lib)
target_link_libraries(chicane_lib INTERFACE ${modules})

# What the static libraries need from the system, as far as this build uses it: CMake package and pkg-config words by target.
set(package_of_Eigen3::Eigen "Eigen3 3.4")
set(package_of_tl::expected "tl-expected")
set(package_of_Threads::Threads "Threads")
set(package_of_fmt::fmt "fmt")
set(package_of_yaml-cpp "yaml-cpp")
set(package_of_zstd::libzstd_shared "zstd")
set(pc_requires_of_Eigen3::Eigen "eigen3")
set(pc_requires_of_fmt::fmt "fmt")
set(pc_requires_of_yaml-cpp "yaml-cpp")
set(pc_requires_of_zstd::libzstd_shared "libzstd")
set(pc_libs_of_Threads::Threads "-pthread")

# Headers that only our own sources include: of no concern to users.
set(built_with Boost::headers Boost::boost nlohmann_json::nlohmann_json)

set(find_dependencies "")
set(pc_requires "")
set(pc_libs "")
set(pc_modules "")
foreach(module IN LISTS modules)
  get_target_property(type ${module} TYPE)
  if(NOT type STREQUAL INTERFACE_LIBRARY)
    list(PREPEND pc_modules "-l${module}")  # the order of the layers, reversed: users before what they use
  endif()
  get_target_property(links ${module} INTERFACE_LINK_LIBRARIES)
  foreach(header_only IN LISTS built_with)
    list(REMOVE_ITEM links "$<LINK_ONLY:${header_only}>")
  endforeach()
  set_target_properties(${module} PROPERTIES INTERFACE_LINK_LIBRARIES "${links}")
  string(REGEX REPLACE "\\$<LINK_ONLY:([^>]*)>" "\\1" links "${links}")
  foreach(link IN LISTS links)
    if(DEFINED package_of_${link})
      list(APPEND find_dependencies "find_dependency(${package_of_${link}})")
      list(APPEND pc_requires ${pc_requires_of_${link}})
      list(APPEND pc_libs ${pc_libs_of_${link}})
    elseif(NOT link MATCHES "^chicane_|BUILD_INTERFACE")
      message(FATAL_ERROR "cmake/Install.cmake: ${module} links ${link}: add the package that provides it")
    endif()
  endforeach()
endforeach()
foreach(words find_dependencies pc_requires pc_libs)
  list(REMOVE_DUPLICATES ${words})
endforeach()
list(JOIN find_dependencies "\n" find_dependencies)
list(JOIN pc_requires " " pc_requires)
list(JOIN pc_modules " " pc_modules)
list(JOIN pc_libs " " pc_libs)

set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/chicane)
install(TARGETS ${modules} chicane_lib EXPORT chicaneTargets FILE_SET HEADERS)
install(EXPORT chicaneTargets NAMESPACE chicane:: DESTINATION ${config_dir})
configure_package_config_file(cmake/chicaneConfig.cmake.in chicaneConfig.cmake INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(chicaneConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/chicaneConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/chicaneConfigVersion.cmake
        DESTINATION ${config_dir})

# The prefix in the .pc file is relative to the file, so that an installation can be moved.
set(pc_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH pc_to_prefix /prefix/${pc_dir} /prefix)
string(REGEX REPLACE "/$" "" pc_to_prefix "${pc_to_prefix}")
configure_file(cmake/chicane.pc.in chicane.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/chicane.pc DESTINATION ${pc_dir})

# What the program can be told by name, and views for others' viewers.
install(DIRECTORY presets cars tracks scenarios layouts DESTINATION ${CMAKE_INSTALL_DATADIR}/chicane)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
