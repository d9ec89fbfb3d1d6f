#include <fmt/chrono.h>

#include <algorithm>
#include <cctype>

#include "jobs/record/command_line.h"
#include "jobs/record/pbrt_options.h"
#include "scene/format/words.h"
#include "system/file_time.h"
#include "system/new_files.h"

namespace frond {

// `frond man`: man pages in roff, from the records of the jobs (man-pages(7), groff_man(7)).

namespace {

constexpr JobParam kManParams[] = {
    JobParam("command", ArgumentKind::text, "Command that the page describes; frond itself by default.",
             {.type = "COMMAND", .positional = true}),
    JobParam("folder", ArgumentKind::text, "Folder for the pages of all commands.",
             {.type = "FOLDER", .path = PathUse::write}),
};

/// Escapes text for roff. The text has no line break.
std::string escaped(std::string_view text) {
  constexpr std::pair<char, const char*> kEscapes[] = {{'\\', "\\e"},  {'-', "\\-"},   {'~', "\\(ti"}, {'^', "\\(ha"},
                                                       {'`', "\\(ga"}, {'"', "\\(dq"}, {'\'', "\\(aq"}};
  std::string result;
  for (const char c : text) {
    const auto found = std::ranges::find(kEscapes, c, &std::pair<char, const char*>::first);
    result += found == std::end(kEscapes) ? std::string(1, c) : found->second;
  }
  return result;
}

std::string bold(std::string_view text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + escaped(text) + "\\fR"; }

/// Returns roff lines of at most 72 characters. Each sentence begins a line (groff's convention), and no line begins
/// with a request.
std::string paragraph(const std::string& text) {
  constexpr size_t kWidth = 72;
  std::string result, line;
  const auto end_line = [&] {
    if (line.starts_with('.')) result += "\\&";
    if (!line.empty()) result += line + '\n';
    line.clear();
  };
  for (const std::string& word : split(text, ' ')) {
    if (word.empty()) continue;
    if (!line.empty() && line.size() + word.size() > kWidth) end_line();
    line += (line.empty() ? "" : " ") + escaped(word);
    if (word.ends_with('.') && word != "...") end_line();
  }
  end_line();
  return result;
}

/// Pages of commands are named frond-COMMAND, as in git.
std::string page_name(std::string_view command) { return command.empty() ? "frond" : "frond-" + std::string(command); }

/// Returns the entry of a parameter: its names in bold, the value's name in italics, and the help text.
std::string entry(const JobParam& p) {
  const std::string value = value_name(p);
  std::string head;
  if (p.positional) {
    head = italic(p.name) + (p.kind == ArgumentKind::texts ? " ..." : "");
  } else {
    for (const std::string& name : option_names(p)) head += (head.empty() ? "" : ", ") + bold(name);
    if (!value.empty()) head += p.implied.empty() ? ' ' + italic(value) : "[=" + italic(value) + ']';
  }
  return ".TP\n" + head + '\n' + paragraph(parameter_help(p) + (p.required && !p.positional ? " Required." : ""));
}

/// Returns a section with one entry for each parameter; "" without parameters.
std::string entries(const char* section, const std::vector<const JobParam*>& params) {
  if (params.empty()) return "";
  std::string text = std::string(".SH ") + section + '\n';
  for (const JobParam* p : params) text += entry(*p);
  return text;
}

/// Section with a list of bold terms and their definitions.
std::string definitions(const char* section, std::span<const std::pair<const char*, const char*>> rows) {
  std::string text = std::string(".SH ") + section + '\n';
  for (const auto& [word, meaning] : rows) text += ".TP\n" + bold(word) + '\n' + paragraph(meaning);
  return text;
}

/// Exit codes of run() in cli/commands.h.
constexpr std::pair<const char*, const char*> kExitStatus[] = {
    {"0", "Done."},
    {"1", "Wrong usage or invalid input; the error is on standard error."},
    {"2", "frond conform found that a law is broken."},
    {"75", "Another frond process has locked the same part; try again later."},
    {"130, 143", "Stopped by SIGINT or SIGTERM; the partial result is kept if --checkpoint or --resume asks for it."},
};

/// Environment variables that all commands read.
constexpr std::pair<const char*, const char*> kEnvironment[] = {
    {"FROND_PLUGIN_PATH", "Folders, separated by colons, whose shared objects are loaded as by --plugin."},
    {"OCIO", "Configuration of OpenColorIO for --display and --view."},
    {"SOURCE_DATE_EPOCH", "Time of writing that files state, in seconds since 1970; by default the current time."},
    {"XDG_CACHE_HOME", "Base of the cache of computed tables, its folder frond; by default ~/.cache."},
};

/// Returns the header and the sections NAME and SYNOPSIS. The date is file_time(), so that builds are reproducible.
std::string head(std::string_view command, const std::string& doc) {
  std::string name = page_name(command);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return fmt::format(".TH {} 1 {:%Y-%m-%d} \"frond {}\" \"frond manual\"\n.SH NAME\n{}.SH SYNOPSIS\n", escaped(name),
                     fmt::gmtime(file_time()), FROND_VERSION, paragraph(page_name(command) + " - " + doc));
}

/// Returns the page frond(1).
std::string overview() {
  std::string text = head("", "a spectral path tracer for plant leaves") +
                     "\\fBfrond\\fR \\fICOMMAND\\fR [\\fIOPTION\\fR ...] [\\fIARGUMENT\\fR ...]\n.SH DESCRIPTION\n";
  text += paragraph(
      "Reads scenes in pbrt-v4's format, renders leaves with models of their tissue, and measures materials and "
      "scenes. "
      "Each command has its own page.");
  text += ".SH COMMANDS\n";
  for (const JobInfo* job : all_jobs())
    text += ".TP\n\\fB" + escaped(page_name(job->name)) + "\\fR(1)\n" + paragraph(std::string(job->doc));
  return text + entries("OPTIONS", frond_params().options) + definitions("EXIT STATUS", kExitStatus) +
         definitions("ENVIRONMENT", kEnvironment);
}

/// Returns the synopsis of a command; optional arguments are in brackets.
std::string synopsis(const JobInfo& job, const CommandParams& params) {
  std::string text = "\\fBfrond\\fR " + bold(job.name) + " [\\fIOPTION\\fR ...]";
  for (const JobParam* p : params.arguments) {
    const std::string name = italic(p->name) + (p->kind == ArgumentKind::texts ? " ..." : "");
    text += ' ' + (p->required ? name : '[' + name + ']');
  }
  return text + '\n';
}

/// Returns the section on pbrt-v4's options, for frond-render(1).
std::string pbrt_section() {
  std::string text = ".SH OPTIONS OF PBRT-V4\n" + paragraph("They are ignored with a warning, or refused.");
  for (const PbrtOption& o : kPbrtOptions) {
    const std::string value = *o.value ? ' ' + italic(o.value) : "";
    text += ".TP\n" + bold(o.name) + value + '\n' +
            paragraph(std::string(o.is_refused ? "Refused: " : "Ignored. ") + o.doc);
  }
  return text;
}

/// Returns the page of a command.
std::string page(const JobInfo& job) {
  const CommandParams params = command_params(job);
  std::string doc = first_sentence(job.doc);
  doc[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(doc[0])));
  std::string text =
      head(job.name, doc) + synopsis(job, params) + ".SH DESCRIPTION\n" + paragraph(std::string(job.doc));
  if (!job.details.empty()) text += ".PP\n" + paragraph(std::string(job.details));
  text += entries("ARGUMENTS", params.arguments) + entries("OPTIONS", params.options);
  if (job.name == "render") text += pbrt_section();
  return text + ".SH SEE ALSO\n\\fBfrond\\fR(1): exit status and environment\n";
}

/// The job: prints one page, or writes all pages to a folder.
Result man(const JobRun& run) {
  const std::string command = run.args.text("command");
  if (!run.args.given("folder"))
    return {.text = command.empty() ? overview() : page(find_job(command)), .is_requested = true};
  NewFiles files(run.args.text("folder"));
  files.write("frond.1", overview());
  for (const JobInfo* job : all_jobs()) files.write(page_name(job->name) + ".1", page(*job));
  files.finish();
  return {};
}

}  // namespace

extern const JobInfo kManJob("man", "Shell", "Print a man page.", "To read it: frond man render | man -l -", kManParams,
                             SessionUse::none, man);

}  // namespace frond
