# find_package(chicane) and pkg-config for users of the library.
include(CMakePackageConfigHelpers)
get_property(modules GLOBAL PROPERTY CHICANE_MODULES)
if(modules)
  install(TARGETS ${modules} EXPORT chicaneTargets FILE_SET HEADERS)
endif()
