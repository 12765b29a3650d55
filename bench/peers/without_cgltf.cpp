// In place of measure_opening.cpp where no cgltf was pointed to.
#include "sections.h"

namespace bendy::bench {

void measure_opening(Table& /*table*/, const std::string& /*path*/, const std::string& /*source*/) {
    fail("built without cgltf: configure with -DBENDY_BENCH_CGLTF=FOLDER");
}

}  // namespace bendy::bench
