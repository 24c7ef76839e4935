# One program replays all corpora: most of the time of compiling a body goes into what it includes, so several make a unit.

# skyloop_replay_sources(RESULT NAME…): the sources of all bodies, and of the table by which replay_main.cpp finds them.
function(skyloop_replay_sources result)
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/replay)
    set(per_unit 1)
    if(SKYLOOP_UNITY)
        set(per_unit 11)
    endif()
    set(declarations "")
    set(rows "")
    set(unit "")
    set(sources ${folder}/bodies.cpp)
    set(count 0)
    list(LENGTH ARGN bodies)
    foreach(name IN LISTS ARGN)
        string(APPEND declarations "extern \"C\" int replay_${name}(const std::uint8_t* data, std::size_t size);\n")
        string(APPEND rows "    {\"${name}\", replay_${name}},\n")
        string(APPEND unit "#define LLVMFuzzerTestOneInput replay_${name}\n#include \"${name}_fuzz.cpp\"\n"
               "#undef LLVMFuzzerTestOneInput\n")
        math(EXPR count "${count} + 1")
        math(EXPR place "${count} % ${per_unit}")
        if(place EQUAL 0 OR count EQUAL bodies)
            list(APPEND sources ${folder}/unit_${count}.cpp)
            file(CONFIGURE OUTPUT ${folder}/unit_${count}.cpp CONTENT "${unit}" @ONLY)
            set(unit "")
        endif()
    endforeach()
    file(CONFIGURE OUTPUT ${folder}/bodies.cpp @ONLY CONTENT "#include \"replay_body.hpp\"

${declarations}
const std::vector<ReplayBody>& replay_bodies() {
    static const std::vector<ReplayBody> bodies{
${rows}    };
    return bodies;
}
")
    set(${result} ${sources} PARENT_SCOPE)
endfunction()
