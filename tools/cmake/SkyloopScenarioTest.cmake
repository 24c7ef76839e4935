# skyloop_scenario_test(NAME SCENARIO FILE [OPTIONS option…] [CLIENT program argument…] [TIMEOUT s]): runs a scenario as a
# ctest case that passes when all that the scenario expects was met. With CLIENT it is run beside a program, live: {port}
# in its arguments, and SKYLOOP_PORT in its environment, become the path of the first pty; the program is ended with the
# run. Without CLIENT the scenario runs on its own clock, as fast as it can. The files of the run, junit.xml among them,
# lie in skyloop/NAME of the binary folder.
#
# Needs SKYLOOP_PROGRAM, the path of skyloop, where the target skyloop is not part of the build, and Python 3.
include_guard()

find_package(Python3 QUIET COMPONENTS Interpreter)
set(SKYLOOP_SCENARIO_TEST_RUNNER ${CMAKE_CURRENT_LIST_DIR}/../python/skyloop_scenario_test.py)

function(skyloop_scenario_test name)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "SCENARIO;TIMEOUT" "OPTIONS;CLIENT")
    if(NOT arg_SCENARIO)
        message(FATAL_ERROR "skyloop_scenario_test(${name}): expected SCENARIO FILE")
    endif()
    if(arg_UNPARSED_ARGUMENTS)
        message(FATAL_ERROR "skyloop_scenario_test(${name}): '${arg_UNPARSED_ARGUMENTS}' is not understood; expected "
                            "SCENARIO, OPTIONS, CLIENT or TIMEOUT")
    endif()
    if(NOT Python3_Interpreter_FOUND)
        message(FATAL_ERROR "skyloop_scenario_test(${name}): needs Python 3")
    endif()
    if(NOT arg_TIMEOUT)
        set(arg_TIMEOUT 300)
    endif()
    if(TARGET skyloop)
        set(program $<TARGET_FILE:skyloop>)
    elseif(SKYLOOP_PROGRAM)
        set(program ${SKYLOOP_PROGRAM})
    else()
        set(program skyloop)
    endif()
    get_filename_component(scenario ${arg_SCENARIO} ABSOLUTE)
    set(client)
    if(arg_CLIENT)
        set(client --client ${arg_CLIENT})
    endif()
    add_test(NAME ${name}
             COMMAND ${Python3_EXECUTABLE} ${SKYLOOP_SCENARIO_TEST_RUNNER} --program ${program} --scenario ${scenario}
                     --folder ${CMAKE_CURRENT_BINARY_DIR}/skyloop/${name} --timeout ${arg_TIMEOUT}
                     "--options=${arg_OPTIONS}" ${client})
    math(EXPR patience "${arg_TIMEOUT} + 30")
    set_tests_properties(${name} PROPERTIES TIMEOUT ${patience})
endfunction()
