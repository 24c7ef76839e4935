# Debian packages by CPack. `cpack` works in a build with -DSKYLOOP_DEBIAN=ON -DCMAKE_INSTALL_PREFIX=/usr; tools/package does all
# of it. SOURCE_DATE_EPOCH, a number of seconds since 1970, dates the changelog and what is in the packages.

set(SKYLOOP_MAINTAINER "skyloop developers <skyloop@packages.skyloop.example>")
set(SKYLOOP_DEBIAN_REVISION 1)
set(debian_version ${PROJECT_VERSION}-${SKYLOOP_DEBIAN_REVISION})

# component:package
set(debian_packages program:skyloop data:skyloop-data library:libskyloop0 development:libskyloop-dev documentation:skyloop-doc)

# What Debian wants of every package: a changelog and a copyright.
function(skyloop_debian_files)
    skyloop_require(Python3 python3 COMPONENTS Interpreter)
    set(epoch $ENV{SOURCE_DATE_EPOCH})
    if(NOT epoch MATCHES "^[0-9]+$")
        message(FATAL_ERROR "SKYLOOP_DEBIAN needs SOURCE_DATE_EPOCH, seconds since 1970 (found '${epoch}'); tools/package sets it")
    endif()
    set(folder ${PROJECT_SOURCE_DIR}/tools/debian)
    set(changelog ${PROJECT_BINARY_DIR}/debian/changelog.Debian)
    file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/debian)
    add_custom_command(OUTPUT ${changelog}.gz
        COMMAND Python3::Interpreter ${folder}/make_changelog.py ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${debian_version}
                ${SKYLOOP_MAINTAINER} ${epoch} > ${changelog}
        COMMAND gzip -9nf ${changelog}
        DEPENDS ${folder}/make_changelog.py ${PROJECT_SOURCE_DIR}/CHANGELOG.md VERBATIM)
    add_custom_target(debian_files ALL DEPENDS ${changelog}.gz)
    foreach(pair IN LISTS debian_packages)
        string(REGEX MATCH "^(.*):(.*)$" whole ${pair})
        set(component ${CMAKE_MATCH_1})
        set(package ${CMAKE_MATCH_2})
        install(FILES ${changelog}.gz ${folder}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
                COMPONENT ${component})
        if(EXISTS ${folder}/${component}/lintian-overrides)
            install(FILES ${folder}/${component}/lintian-overrides DESTINATION share/lintian/overrides RENAME ${package}
                    COMPONENT ${component})
        endif()
    endforeach()
endfunction()
if(SKYLOOP_DEBIAN)
    skyloop_debian_files()
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_VENDOR "skyloop developers")
set(CPACK_PACKAGE_CONTACT "${SKYLOOP_MAINTAINER}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
    WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENTS_ALL program data library development documentation)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${SKYLOOP_DEBIAN_REVISION})
set(CPACK_DEBIAN_PACKAGE_SOURCE skyloop)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_THREADS 1)  # several would cut the compressed streams where there happen to be so many
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)

set(control ${PROJECT_SOURCE_DIR}/tools/debian)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME skyloop)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# systemd provides systemd-sysusers; where there is no systemd, the small program alone will do.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS
    "skyloop-data (= ${debian_version}), systemd-standalone-sysusers | systemd-sysusers")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "libhidapi-hidraw0, libhidapi-libusb0, udev")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "skyloop-doc, gpsd-clients, usbip")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_EXTRA
    "${control}/program/conffiles;${control}/program/postinst;${control}/program/prerm;${control}/program/postrm")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "hardware-in-the-loop GNSS receiver emulator
skyloop computes which satellites stand above an antenna, what atmosphere and
buildings do to their signals and what a receiver makes of them, and speaks as
that receiver, in UBX, NMEA, MSP, MAVLink or SBF, over a pseudo-terminal, a
serial line, USB or TCP, to an autopilot or a program that cannot tell it from
hardware. Faults are injected by scenario, by HTTP or by MAVLink.")

set(CPACK_DEBIAN_DATA_PACKAGE_NAME skyloop-data)
set(CPACK_DEBIAN_DATA_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DATA_PACKAGE_SECTION science)
set(CPACK_COMPONENT_DATA_DESCRIPTION "profiles, models and scenarios of the GNSS receiver emulator skyloop
Profiles of receivers, autopilots and adapters, the geoid EGM96, the tables of
NeQuick-G, mirrors of navigation files, and example scenarios, for the program and the library.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libskyloop0)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "skyloop-data (= ${debian_version})")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA "${control}/library/triggers")
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "GNSS receiver emulator inside other programs, shared library
The emulator skyloop behind an interface in C, led instant by instant by a
simulator, a game engine or a test.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libskyloop-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libskyloop0 (= ${debian_version})")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "GNSS receiver emulator inside other programs, development files
The header of the library libskyloop, and what pkg-config and CMake need to
find it.")

set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_NAME skyloop-doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SECTION doc)
set(CPACK_COMPONENT_DOCUMENTATION_DESCRIPTION "documentation and examples of the GNSS receiver emulator skyloop
Pages about scenarios, receivers, faults, trajectories, wiring and output
files, and examples in C, C++ and Python.")
include(CPack)
