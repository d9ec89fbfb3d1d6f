#include "core/messages/problems.h"

#include <algorithm>

namespace frond {
namespace {

constexpr size_t kMostShown = 20;

std::string joined_lines(const std::vector<std::string>& messages, size_t count, std::string_view prefix, size_t most) {
  std::string text;
  for (size_t i = 0; i < std::min(messages.size(), most); ++i)
    text += fmt::format("{}{}{}", i > 0 ? "\n" : "", prefix, messages[i]);
  if (count > most) text += fmt::format("\n{}and {} more", prefix, count - most);
  return text;
}

}  // namespace

InputErrors::InputErrors(std::vector<std::string> messages, size_t count)
    : InputError({}, ""),
      messages_(std::move(messages)),
      count_(count),
      what_(joined_lines(messages_, count, "", kMostShown)) {}

std::string InputErrors::text(std::string_view prefix, size_t most) const {
  return joined_lines(messages_, count_, prefix, most);
}

void Problems::add(const InputError& error) {
  if (const auto* several = dynamic_cast<const InputErrors*>(&error)) {
    for (const std::string& message : several->messages()) add(InputError({}, message));
    count_ += several->count() - several->messages().size();  // errors whose messages were not stored
    return;
  }
  if (!empty() && dynamic_cast<const Consequence*>(&error)) return;
  if (known_.contains(error.what())) return;
  ++count_;
  if (messages_.size() >= kMostKept) return;
  messages_.emplace_back(error.what());
  known_.emplace(error.what());
}

void Problems::check() const {
  if (count_ == 1) throw InputError({}, messages_[0]);
  if (count_ > 1) throw InputErrors(messages_, count_);
}

}  // namespace frond
