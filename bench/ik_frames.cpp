#include <bendy/runtime.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

// bendy_bench_ik_frames [--targets N] [--seconds N] [--judge N] [--chains] [--softness N] [--restarts N]
// [--state] [--feet] FILE.bendy...:
// chains that reach while a clip plays, 60 frames a second; --softness in thousandths. For each kind of chain, over all
// files, and with --chains for each chain:
//     jumps    share of the frames in which a joint of the chain turns by over 5 degrees more than the clip turns one,
//              three times the target's displacement in its distances from the chain's start included
//     time     of one reach, the better of two, microseconds
//     reached  share of frames, and share of those whose tip is within 0.5 % of the chain's length
//     outside  the largest angle by which a joint is outside its constraint, radians
//     judged   every Nth frame: how much farther from the target than the best pose that a random search of the legal
//              ones finds, in shares of the chain's length; the search starts from the pose found and from anywhere
// Targets stand still anywhere within the chain's length (still), circle (moving), go from the tip to a place out of
// reach (leaving), or are 27 mm beside the tip of the clip (beside).
// --feet instead: 1,000 characters of each file, each in a frame of its own, put both feet 27 mm beside the clip's
// place; milliseconds of these 2,000 reaches, sampling apart: the least, the median and the most of 60 frames.
namespace {

using namespace bendy;

constexpr double kDegree = 3.14159265358979 / 180.0;
constexpr float kRate = 60.0f;

enum class Motion : std::uint8_t { still, moving, leaving, beside };
constexpr std::array kMotions{"still", "moving", "leaving", "beside"};
enum class Kind : std::uint8_t { limb, aim, up_to_10, longer };
constexpr std::array kKinds{"limb", "aim", "chain of up to 10", "longer chain"};

struct Settings {
    std::size_t targets = 8;  ///< of each motion, for each chain
    float seconds = 2.0f;
    std::size_t judge = 0;
    bool is_detailed = false;
    bool has_state = false, is_feet = false;
    ReachOptions options;
};

struct Tally {
    std::vector<double> times, reached_times, behind;
    std::size_t frames = 0, jumps = 0, reached = 0, near = 0;
    double worst_jump = 0.0, outside = 0.0;

    void add(const Tally& other) {
        times.insert(times.end(), other.times.begin(), other.times.end());
        reached_times.insert(reached_times.end(), other.reached_times.begin(), other.reached_times.end());
        behind.insert(behind.end(), other.behind.begin(), other.behind.end());
        frames += other.frames;
        jumps += other.jumps;
        reached += other.reached;
        near += other.near;
        worst_jump = std::max(worst_jump, other.worst_jump);
        outside = std::max(outside, other.outside);
    }
};

double share_of(std::vector<double>& values, double share) {
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

void print(const std::string& name, Tally& t) {
    if (t.frames == 0) return;
    const auto percent = [&](std::size_t part) {
        return 100.0 * static_cast<double>(part) / static_cast<double>(t.frames);
    };
    std::printf(
        "| %-44s | %7zu | %6.2f %% | %5.1f | %7.2f | %7.1f | %7.1f | %7.1f | %7.2f | %5.1f %% | %5.1f %% | %.1e |",
        name.c_str(), t.frames, percent(t.jumps), t.worst_jump, share_of(t.times, 0.5), share_of(t.times, 0.99),
        share_of(t.times, 0.999), share_of(t.times, 1.0), share_of(t.reached_times, 0.5), percent(t.reached),
        percent(t.near), t.outside);
    if (!t.behind.empty()) {
        const auto far = static_cast<std::size_t>(
            std::count_if(t.behind.begin(), t.behind.end(), [](double behind) { return behind > 1e-3; }));
        std::printf(" %zu of %zu, 99.9 %% %.5f, most %.4f |", far, t.behind.size(), share_of(t.behind, 0.999),
                    share_of(t.behind, 1.0));
    }
    std::puts("");
    std::fflush(stdout);
}

class Judged {
public:
    Judged(const Model& model, const Chain& chain) : model_(model), chain_(chain) {
        for (std::uint32_t joint = chain.record.effector;; joint = model.joints()[joint].parent) {
            joints.insert(joints.begin(), joint);
            if (joint == chain.record.start) break;
        }
    }

    glm::vec3 tip(Pose& pose) const {
        const auto& offset = chain_.record.tip_offset;
        return {pose.model_space()[chain_.record.effector] * glm::vec4(offset[0], offset[1], offset[2], 1.0f)};
    }
    glm::vec3 start(Pose& pose) const { return {pose.model_space()[chain_.record.start][3]}; }
    double length(Pose& pose) const {
        double sum = glm::distance(tip(pose), glm::vec3(pose.model_space()[joints.back()][3]));
        for (std::size_t i = 1; i < joints.size(); ++i) {
            sum += glm::distance(glm::vec3(pose.model_space()[joints[i]][3]),
                                 glm::vec3(pose.model_space()[joints[i - 1]][3]));
        }
        return sum;
    }
    /// Returns what to look at: a place, one that circles, one that passes behind, or one 27 mm beside what the clip
    /// looks at, a metre ahead.
    glm::vec3 look_at(Pose& pose, Motion motion, float share, const glm::vec3& place) const {
        const glm::vec3 from = tip(pose);
        const auto& turn = chain_.record.tip_rotation;
        const glm::dquat own(turn[3], turn[0], turn[1], turn[2]);
        const glm::vec3 ahead(turns(pose).back() * (own * glm::dvec3(0.0, 0.0, 1.0)));
        const float angle = 6.2831853f * share;
        switch (motion) {
            case Motion::still:
                return 5.0f * place;
            case Motion::moving:
                return from + glm::vec3(0.5f * std::sin(2.0f * angle), 0.4f * std::cos(angle), 1.0f);
            case Motion::leaving:
                return from + glm::vec3(2.0f * std::sin(angle), 0.1f, 2.0f * std::cos(angle));
            default:
                return from + ahead + glm::vec3(0.01f, 0.02f, -0.015f);
        }
    }
    std::vector<glm::dmat3> turns(Pose& pose) const {
        std::vector<glm::dmat3> all;
        for (const std::uint32_t joint : joints) {
            glm::dmat3 axes(pose.model_space()[joint]);
            for (int i = 0; i < 3; ++i) axes[i] /= glm::length(axes[i]);
            all.push_back(axes);
        }
        return all;
    }
    double outside(const Pose& pose) const {
        double most = 0.0;
        for (const std::uint32_t joint : joints) {
            const Constraint* constraint = model_.ik_constraint(joint);
            if (constraint == nullptr) continue;
            const glm::dquat R =
                to_constraint_space(*constraint, model_.joints()[joint].rest.rotation, pose.local(joint).rotation);
            const glm::dquat by = glm::conjugate(clamp_rotation(*constraint, R)) * R;
            most = std::max(most, 2.0 * std::asin(std::min(1.0, std::sqrt(by.x * by.x + by.y * by.y + by.z * by.z))));
        }
        return most;
    }

    /// Returns the distance of the best legal pose that is found from some random ones and from the given one.
    double best(Pose& pose, const glm::vec3& target, std::mt19937& random) const {
        double least = descend(pose, target, random);
        for (int attempt = 0; attempt < 12; ++attempt) {
            for (const std::uint32_t joint : joints) turn(pose, joint, 3.0, random);
            least = std::min(least, descend(pose, target, random));
        }
        return least;
    }

    std::vector<std::uint32_t> joints;  ///< from the start down

private:
    void turn(Pose& pose, std::uint32_t joint, double most, std::mt19937& random) const {
        std::normal_distribution<double> angle(0.0, most);
        const glm::dvec3 by(angle(random), angle(random), angle(random));
        JointTransform local = pose.local(joint);
        glm::dquat rotation = glm::dquat(local.rotation) * glm::angleAxis(glm::length(by), glm::normalize(by));
        if (const Constraint* constraint = model_.ik_constraint(joint)) {
            const glm::quat rest = model_.joints()[joint].rest.rotation;
            const glm::dquat R = to_constraint_space(*constraint, rest, glm::quat(rotation));
            rotation = from_constraint_space(*constraint, rest, clamp_rotation(*constraint, R));
        }
        local.rotation = glm::quat(glm::normalize(rotation));
        pose.set_local(joint, local);
    }
    double descend(Pose& pose, const glm::vec3& target, std::mt19937& random) const {
        double least = glm::distance(tip(pose), target);
        double step = 0.5;
        std::uniform_int_distribution<std::size_t> any(0, joints.size() - 1);
        for (int tries = 0; tries < 4000 && step > 1e-5; ++tries) {
            const bool is_all = tries % 2 == 0;
            std::vector<JointTransform> before;
            for (const std::uint32_t joint : joints) before.push_back(pose.local(joint));
            if (is_all) {
                for (const std::uint32_t joint : joints) turn(pose, joint, step, random);
            } else {
                turn(pose, joints[any(random)], step, random);
            }
            const double now = glm::distance(tip(pose), target);
            if (now < least) {
                least = now;
                step *= 1.6;
            } else {
                for (std::size_t i = 0; i < joints.size(); ++i) pose.set_local(joints[i], before[i]);
                step *= 0.93;
            }
        }
        return least;
    }

    const Model& model_;
    const Chain& chain_;
};

double angle_of(const glm::dmat3& a, const glm::dmat3& b) {
    double trace = 0.0;
    for (int i = 0; i < 3; ++i) trace += glm::dot(a[i], b[i]);
    return std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0)) / kDegree;
}

Kind kind_of(const Chain& chain) {
    if (chain.solver() == Solver::aim) return Kind::aim;
    if (chain.links == 3) return Kind::limb;
    return chain.links <= 10 ? Kind::up_to_10 : Kind::longer;
}

Tally measure(const Model& model, const Chain& chain, Motion motion, const Settings& settings) {
    Tally tally;
    const Judged judged(model, chain);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> side(-1.0f, 1.0f);
    Pose pose(model);
    for (std::size_t n = 0; n < settings.targets; ++n) {
        const Clip* clip = model.clips().empty() ? nullptr : &model.clips()[n % model.clips().size()];
        (void)sample(pose, clip, clip == nullptr ? 0.0f : clip->start);
        const glm::vec3 start = judged.start(pose), tip = judged.tip(pose);
        const auto length = static_cast<float>(judged.length(pose));
        const auto anywhere = [&] {
            glm::vec3 at(0.0f);
            do at = {side(random), side(random), side(random)};
            while (glm::dot(at, at) > 1.0f || glm::dot(at, at) < 0.09f);
            return start + 0.98f * length * at;
        };
        const glm::vec3 place = anywhere(), far = start + 1.5f * (anywhere() - start);
        std::vector<glm::dmat3> before, clip_before;
        ReachState state(model), tried(model);
        glm::vec3 way_before(0.0f);
        const float seconds = clip == nullptr ? settings.seconds : std::min(settings.seconds, clip->end - clip->start);
        const auto frames = std::max<std::size_t>(2, static_cast<std::size_t>(seconds * kRate));
        for (std::size_t frame = 0; frame < frames; ++frame) {
            const float time = static_cast<float>(frame) / kRate;
            const auto begin = [&] { (void)sample(pose, clip, clip == nullptr ? time : clip->start + time); };
            begin();
            const std::vector<glm::dmat3> own = judged.turns(pose);
            const float share = static_cast<float>(frame) / static_cast<float>(frames - 1);
            glm::vec3 target = place;
            if (motion == Motion::moving) {
                target +=
                    0.2f * length * glm::vec3(std::sin(3.0f * time), std::cos(3.0f * time), std::sin(2.0f * time));
            }
            if (motion == Motion::leaving) target = tip + share * (far - tip);
            if (motion == Motion::beside) target = judged.tip(pose) + glm::vec3(0.01f, 0.02f, -0.015f);
            if (kind_of(chain) == Kind::aim) target = judged.look_at(pose, motion, share, place - start);
            double least = std::numeric_limits<double>::infinity();
            ReachResult result;
            for (int repeat = 0; repeat < 2; ++repeat) {
                begin();
                (void)pose.model_space();
                tried = state;
                ReachOptions options = settings.options;
                options.state = settings.has_state ? &tried : nullptr;
                options.seconds = 1.0f / kRate;
                const auto from = std::chrono::steady_clock::now();
                result = *reach(pose, &chain, target, options);
                least = std::min(
                    least, std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - from).count());
            }
            state = tried;
            ++tally.frames;
            tally.times.push_back(least);
            const bool is_there = result.status == ReachStatus::reached || result.status == ReachStatus::aimed;
            if (is_there) {
                ++tally.reached;
                tally.reached_times.push_back(least);
            }
            const double distance = glm::distance(judged.tip(pose), target);
            tally.near += is_there || distance < 0.005 * static_cast<double>(length) ? 1 : 0;
            tally.outside = std::max(tally.outside, judged.outside(pose));
            const std::vector<glm::dmat3> now = judged.turns(pose);
            if (!before.empty()) {
                double step = 0.0, clip_step = 0.0;
                for (std::size_t i = 0; i < now.size(); ++i) {
                    step = std::max(step, angle_of(before[i], now[i]));
                    clip_step = std::max(clip_step, angle_of(clip_before[i], own[i]));
                }
                const double away = glm::length(target - judged.start(pose));
                const double moved = glm::distance(target - judged.start(pose), way_before);
                const double jump = step - clip_step - (away > 0.0 ? 3.0 * moved / away / kDegree : 0.0);
                tally.jumps += jump > 5.0 ? 1 : 0;
                tally.worst_jump = std::max(tally.worst_jump, jump);
            }
            before = now;
            clip_before = own;
            way_before = target - judged.start(pose);
            if (settings.judge != 0 && frame % settings.judge == settings.judge / 2 && kind_of(chain) != Kind::aim)
                tally.behind.push_back((distance - judged.best(pose, target, random)) / static_cast<double>(length));
        }
    }
    return tally;
}

void plant_feet(const Model& model, const ReachOptions& options) {
    constexpr std::size_t kCharacters = 1000, kFrames = 60;
    std::vector<const Chain*> legs;
    for (const Chain& chain : model.chains()) {
        for (const JointRole& one : model.roles()) {
            const auto role = static_cast<Role>(one.role);
            const bool is_foot = role == Role::left_foot || role == Role::right_foot;
            if (is_foot && one.joint == chain.record.effector) legs.push_back(&chain);
        }
    }
    if (legs.size() != 2 || model.clips().empty()) return (void)std::puts("| no feet or no clip |");
    std::vector<Pose> poses(kCharacters, Pose(model));
    std::vector<double> times;
    std::size_t reached = 0;
    for (std::size_t frame = 0; frame < kFrames; ++frame) {
        std::vector<std::array<ReachRequest, 2>> requests(kCharacters);
        std::vector<std::array<ReachResult, 2>> results(kCharacters);
        for (std::size_t i = 0; i < kCharacters; ++i) {
            const Clip& clip = model.clips()[i % model.clips().size()];
            const float time = 0.37f * static_cast<float>(i) + static_cast<float>(frame) / kRate;
            (void)sample(poses[i], &clip, clip.start + std::fmod(time, std::max(clip.end - clip.start, 1e-3f)));
            for (std::size_t leg = 0; leg < 2; ++leg) {
                const glm::vec3 at = Judged(model, *legs[leg]).tip(poses[i]);
                requests[i][leg] = {legs[leg], at + glm::vec3(0.01f, 0.02f, -0.015f), options};
            }
        }
        const auto from = std::chrono::steady_clock::now();
        for (std::size_t i = 0; i < kCharacters; ++i) (void)reach(poses[i], requests[i], results[i]);
        times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - from).count());
        for (const auto& both : results) {
            for (const ReachResult& one : both) reached += one.status == ReachStatus::reached ? 1 : 0;
        }
    }
    std::printf("| %.2f, %.2f, %.2f ms | %.1f %% reached |\n", share_of(times, 0.0), share_of(times, 0.5),
                share_of(times, 1.0), 100.0 * static_cast<double>(reached) / (2 * kCharacters * kFrames));
}

int run(int argc, char** argv) {
    Settings settings;
    std::vector<std::string> files;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const auto number = [&] { return i + 1 < argc ? std::strtoul(argv[++i], nullptr, 10) : 0ul; };
        if (word == "--targets") {
            settings.targets = number();
        } else if (word == "--seconds") {
            settings.seconds = static_cast<float>(number());
        } else if (word == "--judge") {
            settings.judge = number();
        } else if (word == "--restarts") {
            settings.options.restarts = static_cast<std::uint32_t>(number());
        } else if (word == "--softness") {
            settings.options.softness = static_cast<float>(number()) * 1e-3f;
        } else if (word == "--state") {
            settings.has_state = true;
        } else if (word == "--feet") {
            settings.is_feet = true;
        } else if (word == "--chains") {
            settings.is_detailed = true;
        } else {
            files.push_back(word);
        }
    }
    std::puts(
        "| chains | frames | jumps | worst | median us | 99 % | 99.9 % | most | median reached | reached | near | "
        "outside |");
    std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|");
    std::array<std::array<Tally, kMotions.size()>, kKinds.size()> all;
    for (const std::string& file : files) {
        const auto model = Model::open(file);
        if (!model) {
            std::fprintf(stderr, "%s: cannot be opened\n", file.c_str());
            return 1;
        }
        if (settings.is_feet) {
            std::printf("| %s ", file.substr(file.rfind('/') + 1).c_str());
            plant_feet(*model, settings.options);
            continue;
        }
        for (const Chain& chain : model->chains()) {
            for (std::size_t motion = 0; motion < kMotions.size(); ++motion) {
                Tally tally = measure(*model, chain, static_cast<Motion>(motion), settings);
                if (settings.is_detailed) {
                    print(file.substr(file.rfind('/') + 1) + " " + std::string(chain.name) + " " + kMotions[motion],
                          tally);
                }
                all[static_cast<std::size_t>(kind_of(chain))][motion].add(tally);
            }
        }
    }
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
        Tally sum;
        for (std::size_t motion = 0; motion < kMotions.size(); ++motion) {
            sum.add(all[kind][motion]);
            print(std::string(kKinds[kind]) + ", " + kMotions[motion], all[kind][motion]);
        }
        print(std::string(kKinds[kind]) + ", all", sum);
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return run(argc, argv);
}
