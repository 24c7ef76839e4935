# cmake -DFOLDER=FOLDER -DFUNCTION=NAME -DOUT=FILE -P EmbedFiles.cmake: the files of src/DISTRICT/ROOM/FOLDER as a C++ source, which
# defines std::span<const EmbeddedFile> NAME() in the namespace of the district (base/core/embedded_file.hpp).
cmake_path(GET FOLDER PARENT_PATH room)
cmake_path(GET room PARENT_PATH district)
cmake_path(GET district FILENAME district)
file(GLOB names RELATIVE ${FOLDER} ${FOLDER}/*)
list(SORT names)
set(arrays "")
set(rows "")
set(number 0)
foreach(name IN LISTS names)
    file(READ ${FOLDER}/${name} hex HEX)
    if(hex STREQUAL "")
        message(FATAL_ERROR "${FOLDER}/${name} is empty; expected a file to embed")
    endif()
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${hex}")
    string(APPEND arrays "constexpr char embedded_${number}[] = {${bytes}};\n")
    string(APPEND rows "    {\"${name}\", {embedded_${number}, sizeof(embedded_${number})}},\n")
    math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUT} "#include \"base/core/embedded_file.hpp\"

namespace skyloop::inline ${district} {

std::span<const EmbeddedFile> ${FUNCTION}();

namespace {

${arrays}
constexpr EmbeddedFile ${FUNCTION}_table[] = {
${rows}};

}  // namespace

std::span<const EmbeddedFile> ${FUNCTION}() { return ${FUNCTION}_table; }

}  // namespace skyloop::inline ${district}
")
