# cmake -DPAGE=FOLDER -DOUT=FILE -P EmbedPage.cmake: the files of a folder as a C++ source, for page_files.hpp.
file(GLOB names RELATIVE ${PAGE} ${PAGE}/*)
list(SORT names)
set(arrays "")
set(rows "")
set(number 0)
foreach(name IN LISTS names)
    file(READ ${PAGE}/${name} hex HEX)
    if(hex STREQUAL "")
        message(FATAL_ERROR "${PAGE}/${name} is empty; expected a file of the page")
    endif()
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${hex}")
    string(APPEND arrays "constexpr char page_file_${number}[] = {${bytes}};\n")
    string(APPEND rows "    {\"/${name}\", {page_file_${number}, sizeof(page_file_${number})}},\n")
    math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUT} "#include \"run/control/detail/page_files.hpp\"

namespace skyloop {
namespace {

${arrays}
constexpr PageFile embedded_page_files[] = {
${rows}};

}  // namespace

std::span<const PageFile> page_files() { return embedded_page_files; }

}  // namespace skyloop
")
