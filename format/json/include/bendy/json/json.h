#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <memory>
#include <optional>
#include <ranges>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

// A JSON value. Its names are those of nlohmann/json, which parses and formats numbers and strings behind it; only what
// that library makes of templates in every source is compiled once here. docs/decisions/0081-json-compiled-once.md
namespace bendy {

/// Thrown for a value of the wrong type, a missing member, and text that is not valid UTF-8.
struct JsonError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Where and why a text is not valid JSON.
struct JsonFault {
    std::size_t byte = 0;  ///< how far the parser has read
    std::string reason;
    bool is_out_of_range = false;  ///< a number that does not fit a double: the text itself is JSON
};

enum class JsonKind : std::uint8_t { null, boolean, negative, unsigned_integer, number, string, array, object };

/// The order of an object's members, which is also the order in which they are written.
enum class JsonOrder : std::uint8_t {
    sorted,   ///< by name, each once: a later one replaces an earlier one
    written,  ///< as they were added; parsed text keeps members that it has twice. Finding one takes linear time
};

/// \tparam order  of the members of this value and those in it
template <JsonOrder order>
class BasicJson {
public:
    struct Member;
    template <bool is_const>
    class Iterator;
    using iterator = Iterator<false>;
    using const_iterator = Iterator<true>;
    struct Element;
    using List = std::initializer_list<Element>;

    BasicJson() noexcept = default;
    // NOLINTBEGIN(google-explicit-constructor): a value is written where JSON is expected
    BasicJson(std::nullptr_t) noexcept {}
    template <std::same_as<bool> Bool>
    BasicJson(Bool value) noexcept : kind_(JsonKind::boolean), value_{.boolean = value} {}
    template <std::integral Integer>
    requires(!std::same_as<Integer, bool>) BasicJson(Integer value)
    noexcept {
        if constexpr (std::is_signed_v<Integer>) {
            set_signed(value);
        } else {
            set_unsigned(value);
        }
    }
    template <std::floating_point Number>
    BasicJson(Number value) noexcept : kind_(JsonKind::number), value_{.number = value} {}
    BasicJson(std::string&& text);
    template <class Text>
    requires(std::convertible_to<const Text&, std::string_view>) BasicJson(const Text& text)
        : BasicJson(std::string(std::string_view(text))) {}
    /// An array of a range's values.
    template <class Range>
    requires(!std::same_as<Range, BasicJson> && !std::convertible_to<const Range&, std::string_view> &&
             std::ranges::input_range<const Range> &&
             std::convertible_to<std::ranges::range_reference_t<const Range>, BasicJson>) BasicJson(const Range& range)
        : BasicJson(array()) {
        for (auto&& value : range) push_back(BasicJson(value));
    }
    /// An object, if each element is a list of a name and a value; else an array.
    BasicJson(List list);
    // NOLINTEND(google-explicit-constructor)
    BasicJson(const BasicJson& other) : BasicJson() { copy(other); }
    BasicJson(BasicJson&& other) noexcept
        : kind_(std::exchange(other.kind_, JsonKind::null)), value_(std::exchange(other.value_, {})) {}
    BasicJson& operator=(const BasicJson& other) {
        *this = BasicJson(other);
        return *this;
    }
    BasicJson& operator=(BasicJson&& other) noexcept {
        std::swap(kind_, other.kind_);
        std::swap(value_, other.value_);
        return *this;
    }
    ~BasicJson() {
        if (kind_ >= JsonKind::string) destroy();
    }

    static BasicJson array();
    static BasicJson array(List list);
    static BasicJson object();

    /// Returns nothing for text that is not valid JSON in UTF-8, has a number outside the range of double, or is nested
    /// deeper than kMostLevels.
    static std::optional<BasicJson> parse(std::string_view text, JsonFault* fault = nullptr);
    static constexpr std::size_t kMostLevels = 1000;

    /// How dump handles strings that are not valid UTF-8.
    enum class InvalidText : std::uint8_t { refused, replaced };
    /// \param indentation  -1: all on one line
    /// \param is_ascii  all else as \\uXXXX
    /// Throws JsonError for text that is not UTF-8, if it is refused. Numbers that are not finite are null.
    [[nodiscard]] std::string dump(int indentation = -1, bool is_ascii = false,
                                   InvalidText invalid = InvalidText::refused) const;

    [[nodiscard]] JsonKind kind() const { return kind_; }
    [[nodiscard]] bool is_null() const { return kind_ == JsonKind::null; }
    [[nodiscard]] bool is_boolean() const { return kind_ == JsonKind::boolean; }
    [[nodiscard]] bool is_number_unsigned() const { return kind_ == JsonKind::unsigned_integer; }
    [[nodiscard]] bool is_number_integer() const { return kind_ == JsonKind::negative || is_number_unsigned(); }
    [[nodiscard]] bool is_number_float() const { return kind_ == JsonKind::number; }
    [[nodiscard]] bool is_number() const { return kind_ >= JsonKind::negative && kind_ <= JsonKind::number; }
    [[nodiscard]] bool is_string() const { return kind_ == JsonKind::string; }
    [[nodiscard]] bool is_array() const { return kind_ == JsonKind::array; }
    [[nodiscard]] bool is_object() const { return kind_ == JsonKind::object; }
    [[nodiscard]] bool is_structured() const { return kind_ >= JsonKind::array; }
    /// In words: "number", "string", ...
    [[nodiscard]] const char* type_name() const;

    /// The value, converted between kinds of numbers as by static_cast. Throws JsonError if it is none of Type.
    template <class Type>
    [[nodiscard]] Type get() const {
        if constexpr (std::same_as<Type, bool>) {
            need(JsonKind::boolean);
            return value_.boolean;
        } else if constexpr (std::is_arithmetic_v<Type>) {
            if (kind_ == JsonKind::unsigned_integer) return static_cast<Type>(value_.unsigned_integer);
            if (kind_ == JsonKind::negative) return static_cast<Type>(value_.negative);
            need(JsonKind::number);
            return static_cast<Type>(value_.number);
        } else if constexpr (std::same_as<Type, std::string>) {
            return text();
        } else {
            Type list;
            need(JsonKind::array);
            for (const BasicJson& value : *this) list.push_back(value.template get<typename Type::value_type>());
            return list;
        }
    }
    /// Throws JsonError if it is no string.
    [[nodiscard]] const std::string& text() const {
        need(JsonKind::string);
        return *value_.string;
    }

    /// Of an array or object; 0 of null, 1 of anything else.
    [[nodiscard]] std::size_t size() const;
    [[nodiscard]] bool empty() const { return size() == 0; }

    [[nodiscard]] iterator begin() { return place(0); }
    [[nodiscard]] iterator end() { return place(size()); }
    [[nodiscard]] const_iterator begin() const { return place(0); }
    [[nodiscard]] const_iterator end() const { return place(size()); }
    struct Items;
    /// The members of an object with their names, the values of an array with none: for (const auto& [name, value] :
    /// ...).
    [[nodiscard]] Items items() const { return {this}; }

    /// The value at an index; asserts that there is one. Null becomes an array, which grows.
    BasicJson& operator[](std::size_t index);
    const BasicJson& operator[](std::size_t index) const;
    template <std::integral Index>
    BasicJson& operator[](Index index) {
        return (*this)[static_cast<std::size_t>(index)];
    }
    template <std::integral Index>
    const BasicJson& operator[](Index index) const {
        return (*this)[static_cast<std::size_t>(index)];
    }
    /// The member of an object, which is added as null if there is none; null becomes an object.
    BasicJson& operator[](std::string_view name);
    BasicJson& operator[](const char* name) { return (*this)[std::string_view(name)]; }
    /// The member of an object; null if there is none.
    const BasicJson& operator[](std::string_view name) const;
    const BasicJson& operator[](const char* name) const { return (*this)[std::string_view(name)]; }
    /// Throws JsonError if there is none.
    [[nodiscard]] const BasicJson& at(std::string_view name) const;
    [[nodiscard]] const BasicJson& at(std::size_t index) const;
    [[nodiscard]] iterator find(std::string_view name) { return place(name); }
    [[nodiscard]] const_iterator find(std::string_view name) const { return place(name); }
    [[nodiscard]] bool contains(std::string_view name) const;
    /// The member, or `usual` if there is none.
    template <class Type>
    [[nodiscard]] Type value(std::string_view name, Type usual) const {
        const BasicJson* member = look_up(name);
        return member == nullptr ? std::move(usual) : member->template get<Type>();
    }
    [[nodiscard]] std::string value(std::string_view name, const char* usual) const {
        return value(name, std::string(usual));
    }

    /// Null becomes an array.
    void push_back(BasicJson value);
    void push_back(List list) { push_back(BasicJson(list)); }
    [[nodiscard]] BasicJson& back();
    [[nodiscard]] const BasicJson& back() const;
    [[nodiscard]] const BasicJson& front() const { return (*this)[0u]; }
    /// Adds a member unless there is one of this name.
    void emplace(std::string_view name, BasicJson value);
    /// Takes a member out. \return how many there were: 0 or 1
    std::size_t erase(std::string_view name);
    void erase(iterator member) { erase(std::string_view(member.key())); }
    /// Takes members out, in time that is linear in the object's size.
    void erase_members(const std::vector<std::string>& names);

    /// Numbers are equal by value, whatever kind they are.
    friend bool operator==(const BasicJson& a, const BasicJson& b) { return a.equals(b); }
    template <class Type>
    requires(std::convertible_to<const Type&, BasicJson> && !std::same_as<Type, BasicJson>) friend bool operator==(
        const BasicJson& a, const Type& b) {
        return a.equals(BasicJson(b));
    }

    friend std::ostream& operator<<(std::ostream& out, const BasicJson& json) { return json.write(out); }

private:
    friend struct JsonMaker;  // makes values while it parses
    using Array = std::vector<BasicJson>;
    using Object = std::vector<std::unique_ptr<Member>>;  // members stay in place while others come and go
    union Value {
        bool boolean;
        std::int64_t negative;
        std::uint64_t unsigned_integer = 0;
        double number;
        std::string* string;
        Array* array;
        Object* object;
    };

    void set_signed(std::int64_t value) noexcept;
    void set_unsigned(std::uint64_t value) noexcept {
        kind_ = JsonKind::unsigned_integer;
        value_.unsigned_integer = value;
    }
    /// Makes a copy of a value of this one, which is null.
    void copy(const BasicJson& other);  // NOLINT(misc-no-recursion): the nesting is bounded
    void destroy() noexcept;
    [[nodiscard]] iterator place(std::size_t index) const;
    [[nodiscard]] iterator place(std::string_view name) const;
    void need(JsonKind kind) const {
        if (kind_ != kind) fail_kind(kind);
    }
    [[noreturn]] void fail_kind(JsonKind kind) const;
    [[nodiscard]] bool equals(const BasicJson& other) const;  // NOLINT(misc-no-recursion): the nesting is bounded
    [[nodiscard]] const BasicJson* look_up(std::string_view name) const;
    std::ostream& write(std::ostream& out) const;
    /// Where a member is, or would be added.
    static typename Object::iterator place_in(Object& object, std::string_view name);
    /// Sorts the members that a parser has added.
    void finish_object();

    JsonKind kind_ = JsonKind::null;
    Value value_;
};

template <JsonOrder order>
struct BasicJson<order>::Member {
    Member(std::string its_name, BasicJson its_value) : name(std::move(its_name)), value(std::move(its_value)) {}
    std::string name;
    BasicJson value;
};

/// What a list in braces is made of: lists in it are taken over, not copied.
template <JsonOrder order>
struct BasicJson<order>::Element {
    // NOLINTBEGIN(google-explicit-constructor)
    template <class Type>
    requires(std::convertible_to<Type, BasicJson> && !std::same_as<std::remove_cvref_t<Type>, Element>)
        Element(Type&& from)  // NOLINT(bugprone-forwarding-reference-overload): it is none for an Element
        : value(std::forward<Type>(from)) {}
    Element(List list) : value(list) {}
    // NOLINTEND(google-explicit-constructor)
    mutable BasicJson value;
};

/// Over the values of an array or object; over nothing for other kinds.
template <JsonOrder order>
template <bool is_const>
class BasicJson<order>::Iterator {
public:
    using value_type = BasicJson;
    using difference_type = std::ptrdiff_t;
    using reference = std::conditional_t<is_const, const BasicJson&, BasicJson&>;
    using pointer = std::conditional_t<is_const, const BasicJson*, BasicJson*>;
    using iterator_category = std::forward_iterator_tag;

    Iterator() = default;
    Iterator(pointer element, const std::unique_ptr<Member>* member) : element_(element), member_(member) {}
    Iterator(const Iterator<!is_const>& other)  // NOLINT(google-explicit-constructor)
        requires is_const : element_(other.element_),
                            member_(other.member_) {}

    reference operator*() const { return member_ != nullptr ? (*member_)->value : *element_; }
    pointer operator->() const { return &**this; }
    [[nodiscard]] const std::string& key() const { return (*member_)->name; }
    [[nodiscard]] reference value() const { return **this; }
    Iterator& operator++() {
        if (member_ != nullptr) {
            ++member_;
        } else {
            ++element_;
        }
        return *this;
    }
    Iterator operator++(int) {
        Iterator before = *this;
        ++*this;
        return before;
    }
    bool operator==(const Iterator&) const = default;

private:
    friend class Iterator<!is_const>;
    pointer element_ = nullptr;
    const std::unique_ptr<Member>* member_ = nullptr;
};

template <JsonOrder order>
struct BasicJson<order>::Items {
    struct Item {
        const std::string& name;
        const BasicJson& json;
        [[nodiscard]] const std::string& key() const { return name; }
        [[nodiscard]] const BasicJson& value() const { return json; }
    };
    struct Place : const_iterator {
        const BasicJson* json;
        Item operator*() const;
    };
    const BasicJson* json;
    [[nodiscard]] Place begin() const { return {json->begin(), json}; }
    [[nodiscard]] Place end() const { return {json->end(), json}; }
};

extern template class BasicJson<JsonOrder::sorted>;
extern template class BasicJson<JsonOrder::written>;

/// Whether a text is JSON in UTF-8, however deep it is nested; makes no values.
bool is_json(std::string_view text);

/// For text that must not depend on the order in which it was made, or that has very many members.
using Json = BasicJson<JsonOrder::sorted>;
/// For text that people read.
using OrderedJson = BasicJson<JsonOrder::written>;

}  // namespace bendy
