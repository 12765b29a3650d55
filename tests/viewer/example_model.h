#pragma once

#include <bendy/converter/convert.h>
#include <bendy/runtime.h>

#include "source_folder.h"

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace bendy::test {

/// A glTF file, converted, and the bytes that it lies in.
class ExampleModel {
public:
    explicit ExampleModel(const std::filesystem::path& file, const converter::ConvertOptions& options = {})
        : bytes_(convert(file, options)), model_(open(bytes_)) {}
    ExampleModel(const ExampleModel&) = delete;
    ExampleModel& operator=(const ExampleModel&) = delete;

    const Model& operator*() const { return model_; }
    const Model* operator->() const { return &model_; }

private:
    static std::vector<std::byte> convert(const std::filesystem::path& file, const converter::ConvertOptions& options) {
        converter::Report report;
        auto bytes = converter::convert(file, options, report);
        if (!bytes) throw std::runtime_error(file.string() + ": " + bytes.error().message);
        return *std::move(bytes);
    }
    static Model open(Bytes bytes) {
        Result<Model> model = Model::from_memory(bytes);
        if (!model) throw std::runtime_error("a converted file does not open");
        return *std::move(model);
    }

    std::vector<std::byte> bytes_;
    Model model_;
};

inline std::filesystem::path example(const char* name) {
    return source_folder() / "examples" / name;
}
/// A file of the corpus beside the project; it may be missing.
inline std::filesystem::path corpus(const char* name) {
    return source_folder() / "../shared/corpus/visible" / name;
}

}  // namespace bendy::test
