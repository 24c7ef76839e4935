# Where an installation has what is not a program, a library or its data. In a Debian package udev's and systemd's files lie in
# /lib, as Debian 12 wants them; from source they lie below the prefix, where both look too, be it /usr or /usr/local.
if(SKYLOOP_DEBIAN)
    set(SKYLOOP_SYSTEM_LIBDIR /lib)
    set(SKYLOOP_CONFIG_DIR /etc/skyloop)
    set(SKYLOOP_CONFIG_FULL_DIR /etc/skyloop)
    set(SKYLOOP_DOC_FOLDER skyloop-doc)
else()
    set(SKYLOOP_SYSTEM_LIBDIR lib)
    set(SKYLOOP_CONFIG_DIR etc/skyloop)
    set(SKYLOOP_CONFIG_FULL_DIR ${CMAKE_INSTALL_PREFIX}/etc/skyloop)
    set(SKYLOOP_DOC_FOLDER skyloop)
endif()
