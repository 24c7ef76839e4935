# skyloop_library(NAME SOURCES … [PACKAGES …] [PUBLIC_PACKAGES …]) makes skyloop::NAME. Its own dependencies come from
# tools/layers.txt; the layer test checks the includes against the same table.

set(SKYLOOP_LAYERS_FILE ${PROJECT_SOURCE_DIR}/tools/layers.txt)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${SKYLOOP_LAYERS_FILE})

# The folders that `folder` may include, as written in the table.
function(skyloop_layer_row folder result)
    file(STRINGS ${SKYLOOP_LAYERS_FILE} rows REGEX "^${folder}[ ]*:")
    list(LENGTH rows count)
    if(NOT count EQUAL 1)
        message(FATAL_ERROR "tools/layers.txt: expected one row for '${folder}', found ${count}")
    endif()
    string(REGEX REPLACE "^[^:]*:" "" row "${rows}")
    string(REGEX REPLACE "!.*$" "" row "${row}")
    separate_arguments(row)
    set(${result} ${row} PARENT_SCOPE)
endfunction()

# Warnings, sanitizers and floating-point rules for every target of the project.
add_library(skyloop_options INTERFACE)
target_include_directories(skyloop_options INTERFACE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/firmware-host)
target_compile_options(skyloop_options INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor -Woverloaded-virtual
    -ffp-contract=off
    $<$<BOOL:${SKYLOOP_WERROR}>:-Werror>)
if(SKYLOOP_SANITIZE)
    target_compile_options(skyloop_options INTERFACE -fsanitize=${SKYLOOP_SANITIZE} -fno-omit-frame-pointer
                           -fno-sanitize-recover=all)
    target_link_options(skyloop_options INTERFACE -fsanitize=${SKYLOOP_SANITIZE})
endif()
if(SKYLOOP_COVERAGE)
    target_compile_options(skyloop_options INTERFACE --coverage)
    target_link_options(skyloop_options INTERFACE --coverage)
endif()
if(SKYLOOP_FUZZ)
    target_compile_options(skyloop_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

function(skyloop_library name)
    cmake_parse_arguments(arg "" "" "SOURCES;PACKAGES;PUBLIC_PACKAGES" ${ARGN})
    skyloop_layer_row(${name} layers)
    list(TRANSFORM layers PREPEND skyloop::)
    if(arg_SOURCES)
        add_library(skyloop_${name} STATIC ${arg_SOURCES})
        set(visibility PUBLIC)
        set_target_properties(skyloop_${name} PROPERTIES UNITY_BUILD ${SKYLOOP_UNITY} UNITY_BUILD_BATCH_SIZE 0)
        target_link_libraries(skyloop_${name} PRIVATE ${arg_PACKAGES})
    else()
        add_library(skyloop_${name} INTERFACE)
        set(visibility INTERFACE)
    endif()
    add_library(skyloop::${name} ALIAS skyloop_${name})
    target_link_libraries(skyloop_${name} ${visibility} skyloop_options ${layers} ${arg_PUBLIC_PACKAGES})
endfunction()
