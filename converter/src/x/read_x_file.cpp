#include "read_x_file.h"

#include "encoded_text.h"
#include "object_reader.h"
#include "read_animation.h"
#include "read_mesh.h"
#include "read_rig.h"

#include <utility>

namespace bendy::converter::x {
namespace {

class Reader {
public:
    Reader(std::string_view file, Report& report) : in_(file, report) {}

    XFile read() {
        for (;;) {
            const Token& token = in_.next();
            switch (token.kind) {
                case Token::Kind::end:
                    if (!open_.empty()) in_.refuse("the file ends inside a Frame");
                    return std::move(out_);
                case Token::Kind::close:
                    if (open_.empty()) in_.refuse("there is a '}' without a '{'");
                    open_.pop_back();
                    break;
                case Token::Kind::open:
                    if (open_.empty()) in_.refuse("there is a '{' without a data object's type");
                    in_.skip_unknown("{");
                    break;
                case Token::Kind::uuid:
                    break;
                case Token::Kind::word:
                    read_object(token.text);
                    break;
                default:
                    in_.refuse("a data object is due here");
            }
        }
    }

private:
    void read_object(std::string_view type) {
        const bool is_top = open_.empty();
        if (type == "Frame") {
            begin_frame();
        } else if (type == "Mesh") {
            out_.meshes.push_back(read_mesh(in_, out_.materials));
            out_.meshes.back().frame = is_top ? kNone : open_.back();
        } else if (!is_top && type == "FrameTransformMatrix") {
            in_.head();
            for (double& number : out_.frames[open_.back()].matrix) number = in_.exact_number();
            in_.end_of("FrameTransformMatrix");
        } else if (!is_top && type == "BendyName") {
            out_.frames[open_.back()].name = read_name(in_);
        } else if (!is_top && type == "BendyConstraint") {
            out_.constraints.push_back(read_constraint(in_));
            out_.constraints.back().frame = open_.back();
        } else if (is_top) {
            read_global(type);
        } else {
            in_.skip_unknown(type);
        }
    }

    void read_global(std::string_view type) {
        if (type == "template" || type == "Header") {
            in_.skip(type);
        } else if (type == "Material") {
            out_.materials.push_back(read_material(in_));
        } else if (type == "AnimTicksPerSecond") {
            in_.head();
            out_.ticks_per_second = in_.integer();
            if (out_.ticks_per_second == 0.0) in_.refuse("there must be more than 0 ticks in a second");
            in_.end_of("AnimTicksPerSecond");
        } else if (type == "AnimationSet") {
            out_.sets.push_back(read_animation_set(in_));
        } else if (type == "BendyIkChain") {
            out_.chains.push_back(read_chain(in_));
        } else if (type == "BendyCycle") {
            in_.head();
            std::string set(in_.string());
            out_.cycle_names.emplace_back(std::move(set), decode_text(in_.string()));
            in_.end_of("BendyCycle");
        } else {
            in_.skip_unknown(type);
        }
    }

    void begin_frame() {
        if (out_.frames.size() == kMaxJoints)
            in_.refuse("there are more than " + std::to_string(kMaxJoints) + " frames");
        Frame frame;
        frame.place = in_.place();
        frame.identifier = in_.head();
        frame.name = to_utf8(frame.identifier);
        frame.parent = open_.empty() ? kNone : open_.back();
        open_.push_back(static_cast<std::uint32_t>(out_.frames.size()));
        out_.frames.push_back(std::move(frame));
    }

    ObjectReader in_;
    XFile out_;
    std::vector<std::uint32_t> open_;  ///< frames, the innermost last
};

}  // namespace

XFile read_x_file(std::string_view file, Report& report) {
    return Reader(file, report).read();
}

}  // namespace bendy::converter::x
