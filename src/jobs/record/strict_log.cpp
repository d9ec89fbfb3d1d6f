#include "jobs/record/strict_log.h"

#include <algorithm>

namespace frond {
namespace {

/// Returns the message without quoted text and digits. Warnings of one kind differ only in these.
std::string kind_of(std::string_view message) {
  std::string kind;
  bool is_quoted = false;
  for (const char c : message) {
    if (c == '"') is_quoted = !is_quoted;
    if (!is_quoted && (c < '0' || c > '9')) kind += c;
  }
  return kind;
}

/// Returns the text of the counts.
std::string counts_text(size_t repeats, size_t alike) {
  std::string text;
  if (repeats > 0) text += fmt::format(" and at {} more location{}", repeats, repeats == 1 ? "" : "s");
  if (alike > 0) text += fmt::format(" and {} more like it", alike);
  return text;
}

}  // namespace

void StrictLog::begin(bool is_strict) {
  show_repeats();
  is_strict_ = is_strict;
  problems_ = {};
  count_ = 0;
  warnings_.clear(), by_message_.clear(), by_kind_.clear();
}

/// The first occurrence is logged at once, so that a long run shows its warnings early.
void StrictLog::warn(const Location& where, std::string_view message) const {
  if (is_strict_) return problems_.add(InputError(where, std::string(message) + " (an error in strict mode)"));
  ++count_;
  if (const auto known = by_message_.find(message); known != by_message_.end()) {
    ++warnings_[known->second].repeats;
    return;
  }
  // Further warnings of this kind are counted with the last one shown.
  std::vector<size_t>& alike = by_kind_[kind_of(message)];
  if (alike.size() == kMostAlike) {
    ++warnings_[alike.back()].alike;
    return;
  }
  alike.push_back(warnings_.size());
  by_message_.emplace(message, warnings_.size());
  warnings_.push_back({where, std::string(message)});
  to_.warn(where, message);
}

/// Counts are reset, so that each is logged once.
void StrictLog::show_repeats() const {
  for (Warning& w : warnings_) {
    if (w.repeats > 0 || w.alike > 0) to_.warn(w.first, w.message + ": here" + counts_text(w.repeats, w.alike));
    w.repeats = w.alike = 0;
  }
}

void StrictLog::check() const {
  show_repeats();
  problems_.check();
}

}  // namespace frond
