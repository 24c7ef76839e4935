# skyloop_library(NAME [SOURCES …] [GENERATED …] [PACKAGES …] [PUBLIC_PACKAGES …]) makes skyloop::NAME of all sources of its folder, or
# of the SOURCES named. Its own dependencies come from tools/layers.txt; the layer test checks the includes against the same table.

set(SKYLOOP_LAYERS_FILE ${PROJECT_SOURCE_DIR}/tools/layers.txt)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${SKYLOOP_LAYERS_FILE})

# The folders of all rooms, in the order of the table.
function(skyloop_room_folders result)
    file(STRINGS ${SKYLOOP_LAYERS_FILE} rows REGEX "^[^# ]")
    set(folders "")
    foreach(row IN LISTS rows)
        if(row MATCHES "^\\[([a-z-]+) :")
            set(district ${CMAKE_MATCH_1})
            if(EXISTS ${PROJECT_SOURCE_DIR}/src/${district})
                set(district src/${district})
            endif()
        elseif(row MATCHES "^([a-z_]+) *:")
            list(APPEND folders ${district}/${CMAKE_MATCH_1})
        endif()
    endforeach()
    set(${result} ${folders} PARENT_SCOPE)
endfunction()

# skyloop_embed(RESULT FOLDER FUNCTION): a source that holds the files of a folder beside the list that calls it, and defines
# FUNCTION(), which gives them.
function(skyloop_embed result folder function)
    set(script ${PROJECT_SOURCE_DIR}/tools/cmake/EmbedFiles.cmake)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
    file(GLOB files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*)
    add_custom_command(OUTPUT ${source}
        COMMAND ${CMAKE_COMMAND} -DFOLDER=${CMAKE_CURRENT_SOURCE_DIR}/${folder} -DFUNCTION=${function} -DOUT=${source}
                -P ${script}
        DEPENDS ${files} ${script} VERBATIM)
    set(${result} ${source} PARENT_SCOPE)
endfunction()

# The rooms that `room` may include, as written in the table.
function(skyloop_layer_row room result)
    file(STRINGS ${SKYLOOP_LAYERS_FILE} rows REGEX "^${room}[ ]*:")
    list(LENGTH rows count)
    if(NOT count EQUAL 1)
        message(FATAL_ERROR "tools/layers.txt: expected one row for '${room}', found ${count}")
    endif()
    string(REGEX REPLACE "^[^:]*:" "" row "${rows}")
    string(REGEX REPLACE "!.*$" "" row "${row}")
    separate_arguments(row)
    set(${result} ${row} PARENT_SCOPE)
endfunction()

# Warnings and floating-point rules for every target of the project.
add_library(skyloop_options INTERFACE)
target_include_directories(skyloop_options INTERFACE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src
                           ${PROJECT_SOURCE_DIR}/firmware-host)
target_compile_options(skyloop_options INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor -Woverloaded-virtual
    -ffp-contract=off
    # GCC 12 sees unset members in each optional that it does not inline; clang-tidy and the sanitizers look for real ones.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
    # A table of arrays reads better without a second pair of braces around each.
    $<$<CXX_COMPILER_ID:Clang>:-Wno-missing-braces>
    $<$<BOOL:${SKYLOOP_WERROR}>:-Werror>)

# Sanitizers and coverage, for what is tested; the tests' own code goes without (skyloop_test_code).
add_library(skyloop_instruments INTERFACE)
if(SKYLOOP_SANITIZE)
    target_compile_options(skyloop_instruments INTERFACE -fsanitize=${SKYLOOP_SANITIZE} -fno-omit-frame-pointer
                           -fno-sanitize-recover=all)
    target_link_options(skyloop_instruments INTERFACE -fsanitize=${SKYLOOP_SANITIZE})
endif()
if(SKYLOOP_COVERAGE)
    # Threads that count at once would lose counts, even to below zero.
    target_compile_options(skyloop_instruments INTERFACE --coverage -fprofile-update=atomic)
    target_link_options(skyloop_instruments INTERFACE --coverage)
endif()
if(SKYLOOP_FUZZ)
    target_compile_options(skyloop_instruments INTERFACE -fsanitize=fuzzer-no-link)
endif()

# Under the sanitizers only the folders that compute, and those that run whole simulations in tests, are optimised: all others
# read, arrange and speak, compile in half the time as they are written, and their tests do not feel it. Fuzzers do.
set(SKYLOOP_COMPUTING core time geo gnss flow rinex trajectory sky scene propagation measurement pvt error_model protocol
    firmware fault feed emulator)
function(skyloop_optimise target folder)
    if(SKYLOOP_SANITIZE AND NOT SKYLOOP_FUZZ AND NOT folder IN_LIST SKYLOOP_COMPUTING)
        target_compile_options(${target} PRIVATE -O0)
    endif()
endfunction()

# skyloop_test_code(TARGET [OF skyloop::NAME …]): code that tests, which nobody waits for: compiled fast rather than to be
# fast, and without instruments. The libraries it is about come first in the link: of a function in a header that both have
# compiled, theirs is taken, with its instruments.
function(skyloop_test_code target)
    cmake_parse_arguments(arg "" "" "OF" ${ARGN})
    list(FILTER arg_OF INCLUDE REGEX "^skyloop::")
    target_compile_options(${target} PRIVATE $<$<NOT:$<CONFIG:Release>>:-O0 -g0>)
    foreach(library IN LISTS arg_OF)
        get_target_property(real ${library} ALIASED_TARGET)
        get_target_property(type ${real} TYPE)
        if(type STREQUAL "STATIC_LIBRARY")
            target_link_options(${target} PRIVATE LINKER:--whole-archive $<TARGET_FILE:${real}> LINKER:--no-whole-archive)
        endif()
    endforeach()
endfunction()

function(skyloop_library name)
    cmake_parse_arguments(arg "" "" "SOURCES;GENERATED;PACKAGES;PUBLIC_PACKAGES" ${ARGN})
    skyloop_layer_row(${name} layers)
    list(TRANSFORM layers PREPEND skyloop::)
    if(NOT arg_SOURCES)
        file(GLOB_RECURSE arg_SOURCES CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
    endif()
    if(arg_SOURCES)
        add_library(skyloop_${name} STATIC ${arg_SOURCES} ${arg_GENERATED})
        set(visibility PUBLIC)
        set_target_properties(skyloop_${name} PROPERTIES
            UNITY_BUILD ${SKYLOOP_UNITY} UNITY_BUILD_BATCH_SIZE ${SKYLOOP_UNIT_FILES})
        target_link_libraries(skyloop_${name} PRIVATE skyloop_instruments ${arg_PACKAGES})
        skyloop_optimise(skyloop_${name} ${name})
    else()
        add_library(skyloop_${name} INTERFACE)
        set(visibility INTERFACE)
    endif()
    add_library(skyloop::${name} ALIAS skyloop_${name})
    target_link_libraries(skyloop_${name} ${visibility} skyloop_options ${layers} ${arg_PUBLIC_PACKAGES})
endfunction()
