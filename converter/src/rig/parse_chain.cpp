#include "parse_chain.h"

#include "failure.h"
#include "fields.h"
#include "names.h"

namespace bendy::converter {
namespace {

void read_needed(Fields& fields, std::string_view key, std::string& text) {
    fields.need(key);
    fields.read(key, text);
}

void read_flag(Fields& fields, std::string_view key, std::uint8_t flag, ChainRecord& record) {
    bool is_set = false;
    fields.read(key, is_set);
    if (is_set) record.flags |= flag;
}

void read_weights(Fields& fields, AngleUnit unit, RigChain& chain) {
    const OrderedJson* value = fields.find("weights");
    if (value == nullptr) return;
    Fields weights(*value, fields.place_of("weights"), unit);  // an object, every key once
    for (const auto& [name, weight] : value->items()) {
        const std::string place = weights.place_of(name);
        const float number = to_float(weight, place);
        if (!(number >= 0.0f && number <= 1.0f)) fail(place, shown(weight) + " is not between 0 and 1");
        chain.weights.emplace_back(parse_joint_key(name, place), number);
    }
}

}  // namespace

RigChain parse_chain(const OrderedJson& value, const std::string& place, AngleUnit unit) {
    Fields fields(value, place, unit);
    RigChain chain;
    chain.place = place;
    ChainRecord& record = chain.record;
    read_needed(fields, "name", chain.name);
    read_needed(fields, "start", chain.start);
    read_needed(fields, "effector", chain.effector);
    fields.read("target", chain.target);
    fields.read("pole", chain.pole);
    fields.read_word("solver", kSolverNames, record.solver);
    std::uint64_t number = 0;
    fields.read_integer("iterations", 65535, number);
    record.iterations = static_cast<std::uint16_t>(number);
    number = 0;
    fields.read_integer("priority", 255, number);
    record.priority = static_cast<std::uint8_t>(number);
    fields.read("tolerance", record.tolerance, 0.0f);
    fields.read("pole_vector", record.pole_vector);
    fields.read_angle("pole_angle", record.pole_angle);
    fields.read("tip_offset", record.tip_offset);
    fields.read_rotation("tip_rotation", record.tip_rotation);
    fields.read("position_weight", record.position_weight, 0.0f, 1.0f);
    fields.read("rotation_weight", record.rotation_weight, 0.0f, 1.0f);
    fields.read("influence", record.influence, 0.0f, 1.0f);
    fields.read("stretch", record.stretch, 0.0f);
    fields.read("compress", record.compress, 0.0f, 1.0f);
    read_weights(fields, unit, chain);
    read_flag(fields, "approximated", kApproximated, record);
    read_flag(fields, "proposed", kProposed, record);
    if (const OrderedJson* extras = fields.find("extras"); extras != nullptr && !extras->is_null())
        chain.extras = extras->dump();
    fields.refuse_others();
    return chain;
}

}  // namespace bendy::converter
