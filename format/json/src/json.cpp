#include <bendy/json/json.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>
#include <ostream>

namespace bendy {

template <JsonOrder order>
void BasicJson<order>::set_signed(std::int64_t value) noexcept {
    if (value >= 0) return set_unsigned(static_cast<std::uint64_t>(value));
    kind_ = JsonKind::negative;
    value_.negative = value;
}

template <JsonOrder order>
BasicJson<order>::BasicJson(std::string&& text)
    : kind_(JsonKind::string), value_{.string = new std::string(std::move(text))} {}

template <JsonOrder order>
BasicJson<order>::BasicJson(List list) {
    const bool is_object = std::all_of(list.begin(), list.end(), [](const Element& element) {
        return element.value.is_array() && element.value.size() == 2 && element.value[0u].is_string();
    });
    *this = is_object ? object() : array();
    for (const Element& element : list) {
        if (is_object) {
            BasicJson& pair = element.value;
            emplace(pair[0u].text(), std::move(pair[1u]));
        } else {
            push_back(std::move(element.value));
        }
    }
}

template <JsonOrder order>
void BasicJson<order>::copy(const BasicJson& other) {
    if (other.is_string()) {
        value_.string = new std::string(*other.value_.string);
    } else if (other.is_array()) {
        *this = array();
        value_.array->resize(other.size());
        for (std::size_t i = 0; i < other.size(); ++i) (*value_.array)[i].copy((*other.value_.array)[i]);
    } else if (other.is_object()) {
        *this = object();
        value_.object->reserve(other.size());
        for (const auto& member : *other.value_.object) {
            value_.object->push_back(std::make_unique<Member>(member->name, BasicJson()));
            value_.object->back()->value.copy(member->value);
        }
    } else {
        value_ = other.value_;
    }
    kind_ = other.kind_;
}

template <JsonOrder order>
void BasicJson<order>::destroy() noexcept {
    if (kind_ == JsonKind::string) delete value_.string;
    if (kind_ == JsonKind::array) delete value_.array;
    if (kind_ == JsonKind::object) delete value_.object;
}

template <JsonOrder order>
BasicJson<order> BasicJson<order>::array() {
    BasicJson made;
    made.value_.array = new Array();
    made.kind_ = JsonKind::array;
    return made;
}

template <JsonOrder order>
BasicJson<order> BasicJson<order>::array(List list) {
    BasicJson made = array();
    for (const Element& element : list) made.push_back(std::move(element.value));
    return made;
}

template <JsonOrder order>
BasicJson<order> BasicJson<order>::object() {
    BasicJson made;
    made.value_.object = new Object();
    made.kind_ = JsonKind::object;
    return made;
}

template <JsonOrder order>
const char* BasicJson<order>::type_name() const {
    constexpr std::array<const char*, 8> kNames{"null",   "boolean", "number", "number",
                                                "number", "string",  "array",  "object"};
    return kNames[static_cast<std::size_t>(kind_)];
}

template <JsonOrder order>
void BasicJson<order>::fail_kind(JsonKind kind) const {
    BasicJson wanted;
    wanted.kind_ = kind;
    const std::string text = wanted.type_name();
    wanted.kind_ = JsonKind::null;
    throw JsonError("expected " + text + ", found " + type_name());
}

template <JsonOrder order>
std::size_t BasicJson<order>::size() const {
    if (is_array()) return value_.array->size();
    if (is_object()) return value_.object->size();
    return is_null() ? 0 : 1;
}

template <JsonOrder order>
typename BasicJson<order>::iterator BasicJson<order>::place(std::size_t index) const {
    if (is_array()) return {value_.array->data() + index, nullptr};
    if (is_object()) return {nullptr, value_.object->data() + index};
    return {};
}

template <JsonOrder order>
typename BasicJson<order>::iterator BasicJson<order>::place(std::string_view name) const {
    if (!is_object()) return place(size());
    const auto found = place_in(*value_.object, name);
    if (found == value_.object->end() || (*found)->name != name) return place(size());
    return {nullptr, &*found};
}

template <JsonOrder order>
typename BasicJson<order>::Items::Item BasicJson<order>::Items::Place::operator*() const {
    static const std::string none;
    return {json->is_object() ? this->key() : none, const_iterator::operator*()};
}

template <JsonOrder order>
BasicJson<order>& BasicJson<order>::operator[](std::size_t index) {
    if (is_null()) *this = array();
    need(JsonKind::array);
    if (index >= value_.array->size()) value_.array->resize(index + 1);
    return (*value_.array)[index];
}

template <JsonOrder order>
const BasicJson<order>& BasicJson<order>::operator[](std::size_t index) const {
    need(JsonKind::array);
    assert(index < value_.array->size());
    return (*value_.array)[index];
}

template <JsonOrder order>
typename BasicJson<order>::Object::iterator BasicJson<order>::place_in(Object& object, std::string_view name) {
    if constexpr (order == JsonOrder::sorted) {
        // Members are often added in their order.
        if (object.empty() || object.back()->name < name) return object.end();
        return std::lower_bound(object.begin(), object.end(), name,
                                [](const auto& member, std::string_view wanted) { return member->name < wanted; });
    } else {
        return std::find_if(object.begin(), object.end(), [&](const auto& member) { return member->name == name; });
    }
}

template <JsonOrder order>
const BasicJson<order>* BasicJson<order>::look_up(std::string_view name) const {
    if (!is_object()) return nullptr;
    const auto place = place_in(*value_.object, name);
    return place != value_.object->end() && (*place)->name == name ? &(*place)->value : nullptr;
}

template <JsonOrder order>
BasicJson<order>& BasicJson<order>::operator[](std::string_view name) {
    emplace(name, {});
    return (*place_in(*value_.object, name))->value;
}

template <JsonOrder order>
const BasicJson<order>& BasicJson<order>::operator[](std::string_view name) const {
    static const BasicJson null(nullptr);
    const BasicJson* member = look_up(name);
    return member == nullptr ? null : *member;
}

template <JsonOrder order>
const BasicJson<order>& BasicJson<order>::at(std::string_view name) const {
    need(JsonKind::object);
    const BasicJson* member = look_up(name);
    if (member == nullptr) throw JsonError("there is no member \"" + std::string(name) + '"');
    return *member;
}

template <JsonOrder order>
const BasicJson<order>& BasicJson<order>::at(std::size_t index) const {
    need(JsonKind::array);
    if (index >= size()) throw JsonError("the array has no element " + std::to_string(index));
    return (*value_.array)[index];
}

template <JsonOrder order>
bool BasicJson<order>::contains(std::string_view name) const {
    return look_up(name) != nullptr;
}

template <JsonOrder order>
void BasicJson<order>::push_back(BasicJson value) {
    if (is_null()) *this = array();
    need(JsonKind::array);
    value_.array->push_back(std::move(value));
}

template <JsonOrder order>
BasicJson<order>& BasicJson<order>::back() {
    need(JsonKind::array);
    return value_.array->back();
}

template <JsonOrder order>
const BasicJson<order>& BasicJson<order>::back() const {
    need(JsonKind::array);
    return value_.array->back();
}

template <JsonOrder order>
void BasicJson<order>::emplace(std::string_view name, BasicJson value) {
    if (is_null()) *this = object();
    need(JsonKind::object);
    const auto place = place_in(*value_.object, name);
    if (place != value_.object->end() && (*place)->name == name) return;
    value_.object->insert(place, std::make_unique<Member>(std::string(name), std::move(value)));
}

template <JsonOrder order>
std::size_t BasicJson<order>::erase(std::string_view name) {
    need(JsonKind::object);
    const auto place = place_in(*value_.object, name);
    if (place == value_.object->end() || (*place)->name != name) return 0;
    value_.object->erase(place);
    return 1;
}

template <JsonOrder order>
void BasicJson<order>::erase_members(const std::vector<std::string>& names) {
    need(JsonKind::object);
    std::vector<std::string_view> sorted(names.begin(), names.end());
    std::sort(sorted.begin(), sorted.end());
    std::erase_if(*value_.object,
                  [&](const auto& member) { return std::binary_search(sorted.begin(), sorted.end(), member->name); });
}

template <JsonOrder order>
bool BasicJson<order>::equals(const BasicJson& other) const {
    if (is_number() && other.is_number()) {
        if (kind_ == JsonKind::number || other.kind_ == JsonKind::number) return get<double>() == other.get<double>();
        return kind_ == other.kind_ && value_.unsigned_integer == other.value_.unsigned_integer;
    }
    if (kind_ != other.kind_) return false;
    if (kind_ == JsonKind::boolean) return value_.boolean == other.value_.boolean;
    if (kind_ == JsonKind::string) return *value_.string == *other.value_.string;
    if (is_structured() && size() != other.size()) return false;
    for (iterator a = place(0), b = other.place(0), end = place(size()); is_structured() && a != end; ++a, ++b)
        if ((is_object() && a.key() != b.key()) || !a->equals(*b)) return false;
    return true;
}

template <JsonOrder order>
std::ostream& BasicJson<order>::write(std::ostream& out) const {
    return out << dump();
}

template <JsonOrder order>
void BasicJson<order>::finish_object() {
    if constexpr (order == JsonOrder::sorted) {
        Object& object = *value_.object;
        const auto is_before = [](const auto& a, const auto& b) { return a->name < b->name; };
        if (std::is_sorted(object.begin(), object.end(), is_before) &&
            std::adjacent_find(object.begin(), object.end(),
                               [](const auto& a, const auto& b) { return a->name == b->name; }) == object.end())
            return;
        // The last of equal names is the first of its run, seen from the end.
        std::stable_sort(object.begin(), object.end(), is_before);
        const auto kept = std::unique(object.rbegin(), object.rend(),
                                      [](const auto& a, const auto& b) { return a->name == b->name; });
        object.erase(object.begin(), kept.base());
    }
}

template class BasicJson<JsonOrder::sorted>;
template class BasicJson<JsonOrder::written>;

}  // namespace bendy
