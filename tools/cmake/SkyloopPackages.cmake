# Every foreign package, named with the Debian package that brings it.

# Finds a package by CMake config or module, or stops with the name of the Debian package to install.
function(skyloop_require package debian)
    find_package(${package} QUIET ${ARGN})
    if(NOT ${package}_FOUND)
        message(FATAL_ERROR "skyloop needs ${package}: apt-get install ${debian}  (or run tools/start, which does)")
    endif()
    # Targets that find_package makes are visible only where it was called unless promoted.
    set(${package}_FOUND TRUE PARENT_SCOPE)
endfunction()

set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL TRUE)
list(APPEND CMAKE_MODULE_PATH /usr/share/cmake/geographiclib)
skyloop_require(Eigen3 libeigen3-dev CONFIG)
skyloop_require(GeographicLib libgeographiclib-dev MODULE)
skyloop_require(tl-expected libexpected-dev CONFIG)
skyloop_require(tomlplusplus libtomlplusplus-dev CONFIG)
skyloop_require(nlohmann_json nlohmann-json3-dev CONFIG)
skyloop_require(CLI11 libcli11-dev CONFIG)
skyloop_require(fmt libfmt-dev CONFIG)
skyloop_require(ZLIB zlib1g-dev)
skyloop_require(LibArchive libarchive-dev)
skyloop_require(pugixml libpugixml-dev CONFIG)
skyloop_require(EXPAT libexpat1-dev)
skyloop_require(Threads libc6-dev)
skyloop_require(SQLite3 libsqlite3-dev)
skyloop_require(PROJ libproj-dev CONFIG)
skyloop_require(TIFF libtiff-dev)
skyloop_require(Boost libboost-dev CONFIG)
skyloop_require(OpenSSL libssl-dev)
skyloop_require(CURL libcurl4-gnutls-dev)
if(SKYLOOP_TESTS OR SKYLOOP_FUZZ)
    skyloop_require(GTest libgtest-dev CONFIG)
endif()
if(SKYLOOP_BENCH)
    skyloop_require(benchmark libbenchmark-dev CONFIG)
endif()

if(NOT TARGET GeographicLib::GeographicLib)
    add_library(GeographicLib::GeographicLib INTERFACE IMPORTED GLOBAL)
    target_include_directories(GeographicLib::GeographicLib INTERFACE ${GeographicLib_INCLUDE_DIRS})
    target_link_libraries(GeographicLib::GeographicLib INTERFACE ${GeographicLib_LIBRARIES})
endif()

# Embree 4, or 3.13 that Debian 12 has. Its own configuration wants the headers of its task scheduler as well, which
# no user of its interface needs.
function(skyloop_find_embree)
    foreach(major IN ITEMS 4 3)
        find_path(EMBREE${major}_INCLUDE_DIR embree${major}/rtcore.h)
        find_library(EMBREE${major}_LIBRARY embree${major})
        mark_as_advanced(EMBREE${major}_INCLUDE_DIR EMBREE${major}_LIBRARY)
        if(NOT EMBREE${major}_INCLUDE_DIR OR NOT EMBREE${major}_LIBRARY)
            continue()
        endif()
        file(STRINGS ${EMBREE${major}_INCLUDE_DIR}/embree${major}/rtcore_config.h version REGEX "RTC_VERSION_STRING")
        string(REGEX REPLACE ".*\"([0-9.]+)\".*" "\\1" version "${version}")
        if(version VERSION_LESS 3.13)
            continue()
        endif()
        add_library(Embree::Embree UNKNOWN IMPORTED GLOBAL)
        set_target_properties(Embree::Embree PROPERTIES
            IMPORTED_LOCATION ${EMBREE${major}_LIBRARY}
            INTERFACE_INCLUDE_DIRECTORIES ${EMBREE${major}_INCLUDE_DIR}
            INTERFACE_COMPILE_DEFINITIONS SKYLOOP_EMBREE_MAJOR=${major})
        return()
    endforeach()
    message(FATAL_ERROR
        "skyloop needs Embree 3.13 or 4: apt-get install libembree-dev  (or run tools/start, which does)")
endfunction()
skyloop_find_embree()

# Headers alone, without a CMake package of their own.
find_path(SKYLOOP_OSMIUM_INCLUDE osmium/io/reader.hpp)
find_path(SKYLOOP_PROTOZERO_INCLUDE protozero/pbf_reader.hpp)
mark_as_advanced(SKYLOOP_OSMIUM_INCLUDE SKYLOOP_PROTOZERO_INCLUDE)
if(NOT SKYLOOP_OSMIUM_INCLUDE OR NOT SKYLOOP_PROTOZERO_INCLUDE)
    message(FATAL_ERROR "skyloop needs libosmium: apt-get install libosmium2-dev  (or run tools/start, which does)")
endif()
add_library(osmium::osmium INTERFACE IMPORTED GLOBAL)
target_include_directories(osmium::osmium INTERFACE ${SKYLOOP_OSMIUM_INCLUDE} ${SKYLOOP_PROTOZERO_INCLUDE})
target_link_libraries(osmium::osmium INTERFACE EXPAT::EXPAT ZLIB::ZLIB Threads::Threads)

# libgeotiff has no package configuration in Debian.
find_path(SKYLOOP_GEOTIFF_INCLUDE geotiff.h PATH_SUFFIXES geotiff libgeotiff)
find_library(SKYLOOP_GEOTIFF_LIBRARY geotiff)
mark_as_advanced(SKYLOOP_GEOTIFF_INCLUDE SKYLOOP_GEOTIFF_LIBRARY)
if(NOT SKYLOOP_GEOTIFF_INCLUDE OR NOT SKYLOOP_GEOTIFF_LIBRARY)
    message(FATAL_ERROR "skyloop needs libgeotiff: apt-get install libgeotiff-dev  (or run tools/start, which does)")
endif()
add_library(geotiff::geotiff UNKNOWN IMPORTED GLOBAL)
set_target_properties(geotiff::geotiff PROPERTIES IMPORTED_LOCATION ${SKYLOOP_GEOTIFF_LIBRARY}
                      INTERFACE_INCLUDE_DIRECTORIES ${SKYLOOP_GEOTIFF_INCLUDE} INTERFACE_LINK_LIBRARIES TIFF::TIFF)

# libusb, and the one header of hidapi, whose two libraries are loaded by name when a HID device is first asked for.
find_path(SKYLOOP_LIBUSB_INCLUDE libusb-1.0/libusb.h)
find_library(SKYLOOP_LIBUSB_LIBRARY usb-1.0)
find_path(SKYLOOP_HIDAPI_INCLUDE hidapi/hidapi.h)
mark_as_advanced(SKYLOOP_LIBUSB_INCLUDE SKYLOOP_LIBUSB_LIBRARY SKYLOOP_HIDAPI_INCLUDE)
if(NOT SKYLOOP_LIBUSB_INCLUDE OR NOT SKYLOOP_LIBUSB_LIBRARY)
    message(FATAL_ERROR "skyloop needs libusb: apt-get install libusb-1.0-0-dev  (or run tools/start, which does)")
endif()
if(NOT SKYLOOP_HIDAPI_INCLUDE)
    message(FATAL_ERROR "skyloop needs hidapi: apt-get install libhidapi-dev  (or run tools/start, which does)")
endif()
add_library(libusb::libusb UNKNOWN IMPORTED GLOBAL)
set_target_properties(libusb::libusb PROPERTIES IMPORTED_LOCATION ${SKYLOOP_LIBUSB_LIBRARY}
                      INTERFACE_INCLUDE_DIRECTORIES ${SKYLOOP_LIBUSB_INCLUDE})
add_library(hidapi::header INTERFACE IMPORTED GLOBAL)
target_include_directories(hidapi::header INTERFACE ${SKYLOOP_HIDAPI_INCLUDE})

# libmd has no CMake package.
find_path(SKYLOOP_LIBMD_INCLUDE sha2.h)
find_library(SKYLOOP_LIBMD_LIBRARY md)
mark_as_advanced(SKYLOOP_LIBMD_INCLUDE SKYLOOP_LIBMD_LIBRARY)
if(NOT SKYLOOP_LIBMD_INCLUDE OR NOT SKYLOOP_LIBMD_LIBRARY)
    message(FATAL_ERROR "skyloop needs libmd: apt-get install libmd-dev  (or run tools/start, which does)")
endif()
add_library(libmd::libmd UNKNOWN IMPORTED GLOBAL)
set_target_properties(libmd::libmd PROPERTIES IMPORTED_LOCATION ${SKYLOOP_LIBMD_LIBRARY}
                      INTERFACE_INCLUDE_DIRECTORIES ${SKYLOOP_LIBMD_INCLUDE})
