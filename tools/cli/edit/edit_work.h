#pragma once

#include "files/jobs.h"

#include <bendy/edit/edit.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/result.h>
#include <bendy/json/json.h>
#include <bendy/motion/retarget_clips.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

// `bendy edit`: the steps that its options make, and how they are applied to one file or to several.
namespace bendy::tools {

struct EditArguments {
    std::vector<std::filesystem::path> inputs;
    std::filesystem::path output;                           ///< a folder if there are several inputs
    std::map<std::string, std::vector<std::string>> texts;  ///< of each option that makes steps, in its order
    std::filesystem::path root;
    std::string same_name = "error";
    std::string limits = std::string(motion::kLimitsWords.front());
    bool free_feet = false, rests_alike = false, rests_measured = false;
    bool in_place = false;
    bool quiet = false;
    bool strict = false, json = false;
    unsigned jobs = 0;  ///< 0: one per processor
};

/// The report on one file, and the other files that were read for it.
struct EditReport {
    edit::Log log;
    std::vector<std::pair<std::string, motion::RetargetedClip>> clips;  ///< and the files that they are from
    std::vector<std::filesystem::path> read;
};

/// One change; successive renames of the same kind are one change. A failure without a file is about the input. Steps
/// are called for several files at a time.
using Step = std::function<Result<std::vector<std::byte>, Failure>(Bytes, EditReport&)>;

/// The steps, and the files that their options name.
struct EditSteps {
    std::vector<Step> steps;
    std::vector<std::filesystem::path> reads;
};

/// Returns the steps in the order of the command line.
/// \param options  names of all options of the command line, in their order
EditSteps make_steps(const EditArguments& arguments, const std::vector<std::string>& options);

/// Does the steps one after another. Warnings fail it if the arguments are strict: then they are the report's.
Result<std::vector<std::byte>, Failure> do_steps(const EditArguments& arguments, const std::vector<Step>& steps,
                                                 Bytes file, EditReport& report);

/// A file's report as JSON.
Json edited_report(const std::filesystem::path& output, std::size_t size, const EditReport& report);

/// Edits the inputs, several at a time, each into a file of its own in the output folder or, in place, itself. Prints
/// their reports in their order; throws Failed if anything failed.
void edit_batch(const EditArguments& arguments, const EditSteps& steps);

}  // namespace bendy::tools
