#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/model.h>
#include <bendy/runtime/transform.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace bendy {

struct ReachMemory;  // internal

}  // namespace bendy

namespace BENDY_PUBLIC bendy {

/// What the chains of one character did last: with it (ReachOptions::state), chains that reach in frame after frame do
/// not jump. Where two poses are about equally good, a chain keeps the one that it has; where another has been better
/// for a tenth of a second, it goes there at ReachOptions::speed_limit. Each chain reaches once a frame. Reaching with
/// it allocates nothing.
class ReachState {
public:
    explicit ReachState(const Model& model);

    [[nodiscard]] const Model& model() const { return model_; }
    /// Forgets what the chains did, as after a cut: each then begins with the pose that it has without a state.
    void reset();
    /// The same for one chain, which begins to reach after a pause. Returns an error for one of another model, or null.
    Result<void, CallError> forget(const Chain* chain);

private:
    friend struct ReachMemory;

    struct Link {
        std::uint32_t joint = 0;
        JointTransform posed;  ///< as it came in
        glm::quat found{};     ///< by the call without a state
        glm::quat wanted{};    ///< in the pose that was chosen
        glm::quat done{};      ///< how far the chain came on the way there
        glm::quat trial{};
    };
    struct ChainMemory {
        std::uint32_t first = 0;  ///< of its links, from the start on
        bool is_known = false;
        bool is_on_its_way = false;           ///< to the pose that was chosen
        double waited = 0.0;                  ///< seconds for which another pose has been better
        glm::dvec3 way{0.0};                  ///< from the start to the target, in model space
        glm::dquat base{1.0, 0.0, 0.0, 0.0};  ///< rotation of the start's parent
    };

    Model model_;
    std::vector<ChainMemory> chains_;
    std::vector<Link> links_;
};

}  // namespace bendy
