#include "depfile.h"

#include <cstddef>
#include <string_view>

namespace bendy::cli {
namespace {

/// A file's name as Make reads it: before a space, or a #, every backslash is doubled and one more is put.
std::string escaped(std::string_view name) {
    std::string text;
    std::size_t backslashes = 0;
    for (const char c : name) {
        if (c == ' ' || c == '\t' || c == '#') text += std::string(backslashes + 1, '\\');
        if (c == '$') text += '$';
        text += c;
        backslashes = c == '\\' ? backslashes + 1 : 0;
    }
    return text;
}

}  // namespace

std::string depfile_text(const std::filesystem::path& output, const std::vector<converter::SourceFile>& sources) {
    const std::string target = output.string();
    std::string text = escaped(target) + ':';
    bool is_one_line = target.find('\n') == std::string::npos;
    for (const converter::SourceFile& source : sources) {
        if (!source.stamp.is_there) continue;
        const std::string name = source.file.string();
        is_one_line = is_one_line && name.find('\n') == std::string::npos;
        text += " \\\n  " + escaped(name);
    }
    return is_one_line ? text + '\n' : std::string();
}

}  // namespace bendy::cli
