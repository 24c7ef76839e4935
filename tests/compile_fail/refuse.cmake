# cmake -DCOMPILER=… -DFLAGS=…;… -DSOURCE=… -P refuse.cmake: SOURCE must compile as it stands and must not with
# MUST_NOT_COMPILE defined, and the compiler must complain about the lines that this adds, not about anything else.

function(compile definition result messages)
    execute_process(COMMAND ${COMPILER} ${FLAGS} ${definition} -fsyntax-only ${SOURCE}
                    RESULT_VARIABLE code ERROR_VARIABLE text OUTPUT_VARIABLE text)
    set(${result} ${code} PARENT_SCOPE)
    set(${messages} "${text}" PARENT_SCOPE)
endfunction()

compile("-DCONTROL" code messages)
if(NOT code EQUAL 0)
    message(FATAL_ERROR "${SOURCE}: must compile without its bad line, but:\n${messages}")
endif()

compile("-DMUST_NOT_COMPILE" code messages)
if(code EQUAL 0)
    message(FATAL_ERROR "${SOURCE}: its bad line compiles")
endif()

# Lines between `#ifdef MUST_NOT_COMPILE` and `#endif`.
file(STRINGS ${SOURCE} lines)
cmake_path(GET SOURCE FILENAME name)
set(number 0)
set(inside FALSE)
set(complained FALSE)
foreach(line IN LISTS lines)
    math(EXPR number "${number} + 1")
    if(line MATCHES "^#ifdef MUST_NOT_COMPILE")
        set(inside TRUE)
    elseif(line MATCHES "^#endif")
        set(inside FALSE)
    elseif(inside AND messages MATCHES "/${name}:${number}:[0-9]+: error:")
        set(complained TRUE)
    endif()
endforeach()
if(NOT complained)
    message(FATAL_ERROR "${SOURCE}: refused for another reason than its bad line:\n${messages}")
endif()
