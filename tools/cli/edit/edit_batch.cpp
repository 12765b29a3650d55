#include "edit/edit_work.h"
#include "files/batch_plan.h"
#include "files/input.h"
#include "files/output.h"
#include "reports/conversion.h"
#include "reports/json.h"
#include "reports/messages.h"

#include <cstdint>
#include <iomanip>
#include <iostream>
#include <optional>
#include <sstream>

namespace bendy::tools {
namespace {

/// The outcome for one file.
struct Edited {
    converter::Report converted;  ///< of a file of another kind
    EditReport report;
    std::uint64_t before = 0, after = 0;  ///< bytes
    double seconds = 0.0;
    std::optional<Failure> failure;
};

class EditBatch : Jobs {
public:
    EditBatch(const EditArguments& arguments, const std::vector<Step>& steps, BatchPlan plan)
        : Jobs("editing", !arguments.quiet),
          arguments_(arguments),
          steps_(steps),
          plan_(std::move(plan)),
          outcomes_(plan_.files.size()) {}

    void run() {
        failed_ = plan_.unread.size();
        for (const BatchProblem& problem : plan_.unread) print_failure(problem.input, {problem.input, problem.what});
        std::vector<std::filesystem::path> inputs;
        for (const BatchFile& file : plan_.files) inputs.push_back(file.input);
        do_all(inputs, jobs_of(arguments_.jobs));
        if (failed_ != 0) throw Failed{};
    }

private:
    std::optional<Failure> work(std::size_t job, WriteLock& writing) override {
        const BatchFile& file = plan_.files[job];
        Edited& outcome = outcomes_[job];
        std::vector<std::byte> edited;
        {
            const auto character = read(file.input, outcome.converted);
            if (!character) return character.error();
            outcome.before = character->bytes().size();
            auto done = do_steps(arguments_, steps_, character->bytes(), outcome.report);
            if (!done) return done.error();
            edited = *std::move(done);
        }  // the output may be the input, and Windows cannot replace a mapped file
        outcome.after = edited.size();
        writing.lock();
        return write_output(file.output, edited, outcome.report.read);
    }

    [[nodiscard]] Result<CharacterFile, Failure> read(const std::filesystem::path& input,
                                                      converter::Report& report) const {
        auto mapped = InputBytes::open(input);
        if (!mapped) return Failure{input, why_not_opened(input, mapped.error())};
        const std::string other = arguments_.in_place ? why_not_bendy(input, mapped->bytes()) : std::string();
        if (!other.empty()) return Failure{input, other};
        auto character = read_character(input, *std::move(mapped), arguments_.root, report);
        if (!character) return Failure{file_of(character.error(), input), describe(character.error())};
        return *std::move(character);
    }

    void finish(std::size_t job, std::optional<Failure> failure, Seconds time) override {
        Edited& outcome = outcomes_[job];
        outcome.seconds = time.count();
        outcome.failure = std::move(failure);
        if (!outcome.failure) return;
        ++failed_;
        if (outcome.failure->file.empty()) outcome.failure->file = plan_.files[job].input;
    }

    void tell(std::size_t job) override {
        const BatchFile& file = plan_.files[job];
        const Edited& outcome = outcomes_[job];
        if (arguments_.json) {
            print_as_json(file, outcome);
        } else {
            print_as_text(file, outcome);
        }
        std::cout.flush();
        outcomes_[job] = {};  // frees the memory
    }

    static void print_as_json(const BatchFile& file, const Edited& outcome) {
        Json json = edited_report(file.output, outcome.after, outcome.report);
        json["input"] = file.input.string();
        if (outcome.failure) {
            print_failure(file.input, *outcome.failure);
            json["error"] = {{"file", outcome.failure->file.string()}, {"message", outcome.failure->what}};
        }
        print_report(json);
    }

    void print_as_text(const BatchFile& file, const Edited& outcome) const {
        print_warnings(file.input, outcome.converted);
        for (const std::string& warning : outcome.report.log.warnings) warn(file.input, warning);
        if (outcome.failure) return print_failure(file.input, *outcome.failure);
        if (arguments_.quiet) return;
        std::ostringstream line;
        line << escaped(file.input.string()) << " -> " << escaped(file.output.string()) << "  "
             << grouped(outcome.after) << " bytes" << change_of_size(outcome.before, outcome.after) << "  "
             << std::fixed << std::setprecision(1) << outcome.seconds << " s\n";
        std::cout << line.str();
        for (const std::string& done : outcome.report.log.done) std::cout << "  " << printable(done) << '\n';
    }

    void end(bool is_interrupted) override {
        if (!is_interrupted) return;
        std::cout.flush();
        std::cerr << "bendy: interrupted: " << done() - failed_ << " of " << plan_.files.size() << " files edited\n";
    }

    [[nodiscard]] std::string note() const override {
        return failed_ == 0 ? std::string() : ", " + std::to_string(failed_) + " failed";
    }

    const EditArguments& arguments_;
    const std::vector<Step>& steps_;
    const BatchPlan plan_;
    std::vector<Edited> outcomes_;  // by file
    std::size_t failed_ = 0;        // guarded by the state of Jobs
};

}  // namespace

void edit_batch(const EditArguments& arguments, const EditSteps& steps) {
    BatchPlan plan = plan_batch({arguments.inputs, arguments.output, steps.reads, true, arguments.in_place, {}});
    for (const BatchProblem& clash : plan.clashes) print_failure(clash.input, {clash.output, clash.what});
    if (!plan.clashes.empty()) throw Failed{};
    make_output_folder(arguments.output);
    EditBatch(arguments, steps.steps, std::move(plan)).run();
}

}  // namespace bendy::tools
