#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::extensions {

/// A list in extensions: the names of its elements, which are empty where they have none.
struct NamedList {
    std::vector<std::string> names;
    std::map<std::string_view, std::uint32_t> first;  ///< by name: the first element that has it

    NamedList() = default;
    NamedList(NamedList&&) = default;
    NamedList(const NamedList&) = delete;
    NamedList& operator=(NamedList&&) = delete;
    NamedList& operator=(const NamedList&) = delete;
    ~NamedList() = default;
};

/// Where a JSON pointer leads in the extensions of HEAD: "/extensions/KHR_lights_punctual/lights/0/intensity". The
/// extensions are parsed once, for all pointers; each list is read once.
class PointedLists {
public:
    /// \param json  an object of extensions by name; anything else has no lists
    explicit PointedLists(std::string_view json);
    PointedLists(PointedLists&&) noexcept;
    PointedLists(const PointedLists&) = delete;
    PointedLists& operator=(PointedLists&&) = delete;
    PointedLists& operator=(const PointedLists&) = delete;
    ~PointedLists();

    /// Returns true if there is a value at the pointer, or an object that could have it as a member.
    [[nodiscard]] bool has(std::string_view pointer) const;
    /// Returns the list at a pointer; an empty one if there is none.
    const NamedList& list(std::string_view pointer);

    /// The new number of a list's element, or nothing if it no longer exists. \param before, after  pointers to the
    /// list, with the numbers of the lists around it as they were and as they become
    using NewElement =
        std::function<std::optional<std::uint32_t>(std::string_view before, std::string_view after, std::uint32_t)>;
    /// Returns the pointer with the new numbers of the list elements that it passes through, or nothing if one of them
    /// no longer exists. A pointer that leads out of the extensions does not change.
    [[nodiscard]] std::optional<std::string> with_elements(std::string_view pointer, const NewElement& now) const;

private:
    struct Parsed;
    std::unique_ptr<Parsed> parsed_;
    std::map<std::string, NamedList, std::less<>> lists_;
};

}  // namespace bendy::extensions
