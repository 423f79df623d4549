// The identity of a stack, which stack.toml holds in its comments.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace vkfv::scan {

struct StackDescription;

inline constexpr std::string_view configuration_name = "stack.toml";

// The text of stack.toml: the configuration, and above it the identity as comments.
std::string stack_text(const StackDescription& description);

// The identity in such a text, as in StackDescription, and the digest that it states; empty: there is none.
std::string identity_in(std::string_view stack_text);
std::string digest_in(std::string_view stack_text);

// The identity of the stack in a folder, as in StackDescription. Throws InputError if there is none.
std::string stored_identity(const std::filesystem::path& folder);
// The digest of the stack in a folder; empty if there is none. Throws InputError if the file cannot be read.
std::string stored_digest(const std::filesystem::path& folder);

// A line for each key in which two identities differ, "\n  trace.seed: 1 there, 2 here"; empty if they are the same.
std::string identity_differences(std::string_view there, std::string_view here);

} // namespace vkfv::scan
