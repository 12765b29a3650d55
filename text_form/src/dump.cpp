#include <bendy/text_form/dump.h>

#include "leaf_dumper.h"

#include <vector>

namespace bendy::text_form {
namespace {

/// Writes the chunks in file order.
class Dumper {
public:
    Dumper(const ChunkTree& tree, const DumpOptions& options, const Progress& progress)
        : tree_(tree), options_(options), progress_(progress), leaf_(tree, out_, [this] { tick(); }) {}

    std::string run() && {
        out_ = "{\"bendy_text\": 1,\n ";
        for (number_ = 0; number_ < tree_.chunks().size(); ++number_) {
            end_containers();
            begin_chunk();
            tick();
        }
        end_containers();
        out_ += '\n';
        return std::move(out_);
    }

private:
    void end_containers() {
        while (!open_.empty() && tree_[open_.back()].end == number_) {
            const std::uint32_t container = open_.back();
            open_.pop_back();
            out_ += ']';
            end_chunk(container);
        }
    }

    void begin_chunk() {
        const Chunk& chunk = tree_[number_];
        if (number_ != 0) {
            const bool is_first = number_ == open_.back() + 1;
            out_.append(is_first ? "\n" : ",\n").append(indentation(open_.size()), ' ').append(1, '{');
        }
        out_.append(1, '"').append(chunk.id.letters().data()).append("\": ");
        if (chunk.is_container()) {
            out_ += '[';
            open_.push_back(number_);
            return;
        }
        if (tree_.encoding_fault(number_)) {
            out_ += "null";
        } else {
            leaf_.dump(number_, open_.size());
        }
        end_chunk(number_);
    }

    /// Writes what follows a chunk's content.
    void end_chunk(std::uint32_t number) {
        const Chunk& chunk = tree_[number];
        if (chunk.is_required()) out_ += ", \"required\": true";
        if (chunk.codec() != 0 && (!options_.decode || tree_.encoding_fault(number))) {
            out_.append(", \"codec\": ").append(std::to_string(chunk.codec())).append(", \"encoded\": ");
            append_json_hex(out_, tree_.stored(number), open_.size());
        }
        out_ += '}';
    }

    void tick() {
        if (progress_) progress_(tree_[number_].offset, tree_.bytes().size());
    }

    const ChunkTree& tree_;
    const DumpOptions& options_;
    const Progress& progress_;
    std::string out_;
    LeafDumper leaf_;
    std::uint32_t number_ = 0;
    std::vector<std::uint32_t> open_;  // open containers
};

}  // namespace

std::string dump(const ChunkTree& tree, const DumpOptions& options, const Progress& progress) {
    return Dumper(tree, options, progress).run();
}

}  // namespace bendy::text_form
