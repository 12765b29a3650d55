#pragma once

#include <vector>

namespace bendy::viewer {

/// What a rough surface mirrors of light that comes evenly from everywhere is f0 * scale + f90 * bias. `side` rows of
/// `side` pairs (scale, bias): entry (i, j) is for perceptual roughness (i + 0.5) / side and a cosine between normal
/// and view of (j + 0.5) / side. GGX with the height-correlated Smith term and Schlick's Fresnel term, as glTF 2.0's
/// appendix B has them; integrated as in Karis, "Real shading in Unreal Engine 4", 2013.
std::vector<float> reflectance_table(unsigned side);

}  // namespace bendy::viewer
