# Headers, libraries, CMake package and pkg-config file. Nothing installed names an absolute path, so a prefix may be
# moved or packed as it is.
include(CMakePackageConfigHelpers)

option(SOFTSHADOW_INSTALL "Install the library, its headers and its package files" ${PROJECT_IS_TOP_LEVEL})
if(NOT SOFTSHADOW_INSTALL)
  return()
endif()

set(softshadow_package ${CMAKE_INSTALL_LIBDIR}/cmake/softshadow)
set(softshadow_kinds)
foreach(kind static shared)
  if(TARGET softshadow_${kind})
    set_target_properties(softshadow_${kind} PROPERTIES EXPORT_NAME ${kind})
    list(APPEND softshadow_kinds softshadow_${kind})
  endif()
endforeach()

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/softshadow DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        COMPONENT development FILES_MATCHING PATTERN "*.h")
install(TARGETS ${softshadow_kinds} EXPORT softshadow
        RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT development
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(EXPORT softshadow NAMESPACE softshadow:: FILE softshadowTargets.cmake DESTINATION ${softshadow_package}
        COMPONENT development)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/softshadowConfig.cmake.in softshadowConfig.cmake
                              INSTALL_DESTINATION ${softshadow_package} NO_SET_AND_CHECK_MACRO)
# Until 1.0 every minor version may break what came before, and the soversion says so too.
write_basic_package_version_file(softshadowConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/softshadowConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/softshadowConfigVersion.cmake
        DESTINATION ${softshadow_package} COMPONENT development)

# The .pc file finds its prefix from where it lies; folders given as absolute paths stay what they are.
file(RELATIVE_PATH softshadow_pc_prefix /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
string(REGEX REPLACE "/$" "" softshadow_pc_prefix ${softshadow_pc_prefix})
cmake_path(ABSOLUTE_PATH CMAKE_INSTALL_INCLUDEDIR BASE_DIRECTORY "\${prefix}" OUTPUT_VARIABLE softshadow_pc_includedir)
cmake_path(ABSOLUTE_PATH CMAKE_INSTALL_LIBDIR BASE_DIRECTORY "\${prefix}" OUTPUT_VARIABLE softshadow_pc_libdir)
configure_file(${PROJECT_SOURCE_DIR}/cmake/softshadow.pc.in softshadow.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/softshadow.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
        COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
