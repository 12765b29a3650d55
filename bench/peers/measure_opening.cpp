#include "sections.h"

#define CGLTF_IMPLEMENTATION
#include <cgltf.h>
#include <meshoptimizer.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

namespace bendy::bench {
namespace {

/// Decodes gltfpack's buffer views, which cgltf leaves to its user.
void unpack_meshopt(cgltf_data& data, std::vector<std::unique_ptr<std::byte[]>>& unpacked) {
    for (std::size_t k = 0; k < data.buffer_views_count; ++k) {
        cgltf_buffer_view& view = data.buffer_views[k];
        if (view.has_meshopt_compression == 0) continue;
        const cgltf_meshopt_compression& packed = view.meshopt_compression;
        const auto* const from = static_cast<const unsigned char*>(packed.buffer->data) + packed.offset;
        void* const to = unpacked.emplace_back(new std::byte[packed.count * packed.stride]).get();
        int status = 0;
        if (packed.mode == cgltf_meshopt_compression_mode_attributes) {
            status = meshopt_decodeVertexBuffer(to, packed.count, packed.stride, from, packed.size);
        } else if (packed.mode == cgltf_meshopt_compression_mode_triangles) {
            status = meshopt_decodeIndexBuffer(to, packed.count, packed.stride, from, packed.size);
        } else {
            status = meshopt_decodeIndexSequence(to, packed.count, packed.stride, from, packed.size);
        }
        check(status == 0, "meshoptimizer");
        if (packed.filter == cgltf_meshopt_compression_filter_octahedral)
            meshopt_decodeFilterOct(to, packed.count, packed.stride);
        if (packed.filter == cgltf_meshopt_compression_filter_quaternion)
            meshopt_decodeFilterQuat(to, packed.count, packed.stride);
        if (packed.filter == cgltf_meshopt_compression_filter_exponential)
            meshopt_decodeFilterExp(to, packed.count, packed.stride);
        view.data = to;
    }
}

bool is_index(const cgltf_accessor& accessor) {
    return accessor.type == cgltf_type_scalar && accessor.component_type != cgltf_component_type_r_32f;
}

/// All that a program needs before the first pose: every accessor as an array of numbers.
void open_gltf(const std::string& path) {
    cgltf_options options{};
    cgltf_data* data = nullptr;
    check(cgltf_parse_file(&options, path.c_str(), &data) == cgltf_result_success, path + ": cgltf_parse_file");
    check(cgltf_load_buffers(&options, data, path.c_str()) == cgltf_result_success, path + ": cgltf_load_buffers");
    std::vector<std::unique_ptr<std::byte[]>> unpacked;
    unpack_meshopt(*data, unpacked);
    std::vector<std::unique_ptr<float[]>> arrays;
    std::vector<std::unique_ptr<std::uint32_t[]>> indices;
    for (std::size_t k = 0; k < data->accessors_count; ++k) {
        const cgltf_accessor& accessor = data->accessors[k];
        if (is_index(accessor)) {
            std::uint32_t* const to = indices.emplace_back(new std::uint32_t[accessor.count]).get();
            cgltf_accessor_unpack_indices(&accessor, to, sizeof(std::uint32_t), accessor.count);
        } else {
            const std::size_t floats = accessor.count * cgltf_num_components(accessor.type);
            cgltf_accessor_unpack_floats(&accessor, arrays.emplace_back(new float[floats]).get(), floats);
        }
    }
    for (std::size_t k = 0; k < data->buffer_views_count; ++k) {
        if (data->buffer_views[k].has_meshopt_compression != 0) data->buffer_views[k].data = nullptr;  // not cgltf's
    }
    cgltf_free(data);
}

void open_bendy(const std::string& path, Sums sums, bool poses) {
    OpenOptions options;
    options.sums = sums;
    const auto model = Model::open(path, options);
    check(model.has_value(), path + ": Model::open");
    if (!poses) return;
    Pose pose(*model);
    if (!model->clips().empty()) sample_at(pose, model->clips().front(), model->clips().front().start);
    (void)pose.model_space();
}

}  // namespace

void measure_opening(Table& table, const std::string& path, const std::string& source) {
    (void)open_model(path);  // or says what is wrong with the file
    open_gltf(source);
    const Contestant theirs{"cgltf, all accessors", [&] { open_gltf(source); }};
    const auto race = [&](const char* what, Sums sums, bool poses) {
        constexpr double kNanoseconds = 1e3;  // in a microsecond
        table.compare({name_of(path), what, "us", kNanoseconds},
                      {{"ours", [&, sums, poses] { open_bendy(path, sums, poses); }}, theirs});
    };
    race("open", Sums::checked, false);
    race("open, first pose", Sums::checked, true);
    race("open, first pose, sums later", Sums::later, true);
}

}  // namespace bendy::bench
