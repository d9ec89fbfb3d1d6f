#include <fmt/chrono.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <span>

#include "cli/command_facts.h"
#include "cli/commands.h"
#include "core/error.h"
#include "report/text_output.h"
#include "scene/words.h"
#include "system/file_time.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

/// Words of roff, without a line break.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) switch (c) {
      case '\\':
        result += "\\e";
        break;
      case '-':
        result += "\\-";
        break;
      case '~':
        result += "\\(ti";
        break;
      case '^':
        result += "\\(ha";
        break;
      case '`':
        result += "\\(ga";
        break;
      case '"':
        result += "\\(dq";
        break;
      case '\'':
        result += "\\(aq";
        break;
      default:
        result += c;
    }
  return result;
}

std::string bold(std::string_view text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + escaped(text) + "\\fR"; }

/// Lines of text, a sentence on lines of its own; none is taken for a request.
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

std::string page_name(const CommandFacts& command) { return command.name.empty() ? "frond" : "frond-" + command.name; }

std::string sentence(std::string text) {
  if (!text.empty() && text.back() != '.') text += '.';
  return text;
}

std::string option_entry(const OptionFacts& option) {
  std::string head;
  for (const std::string& name : option.names) head += (head.empty() ? "" : ", ") + bold(name);
  if (option.names.empty())
    head = italic(option.value) + (option.repeats ? " ..." : "");
  else if (!option.value.empty())
    head += ' ' + italic(option.value);
  std::string text = sentence(option.doc);
  for (const std::string& limit : option.limits) text += ' ' + limit;
  if (option.required && !option.names.empty()) text += " Required.";
  return ".TP\n" + head + '\n' + paragraph(text);
}

std::string entries(const char* section, const std::vector<OptionFacts>& options) {
  if (options.empty()) return "";
  std::string text = std::string(".SH ") + section + '\n';
  for (const OptionFacts& option : options) text += option_entry(option);
  return text;
}

std::string synopsis(const CommandFacts& command) {
  std::string text = ".SH SYNOPSIS\n\\fBfrond\\fR ";
  if (command.name.empty()) return text + "\\fICOMMAND\\fR [\\fIOPTION\\fR ...] [\\fIWORD\\fR ...]\n";
  text += bold(command.name) + " [\\fIOPTION\\fR ...]";
  for (const OptionFacts& word : command.words) {
    const std::string name = italic(word.value) + (word.repeats ? " ..." : "");
    text += ' ' + (word.required ? name : '[' + name + ']');
  }
  return text + '\n';
}

/// What a table says of words, one of them bold.
std::string definitions(const char* section, std::span<const std::pair<const char*, const char*>> rows) {
  std::string text = std::string(".SH ") + section + '\n';
  for (const auto& [word, meaning] : rows) text += ".TP\n" + bold(word) + '\n' + paragraph(meaning);
  return text;
}

constexpr std::pair<const char*, const char*> kExitStatus[] = {
    {"0", "Done."},
    {"1", "Bad use or bad input; a message on standard error says what is wrong."},
    {"2", "frond conform has found a law broken."},
    {"75", "Another frond is at work on the same part; try again later."},
    {"130, 143", "Stopped by SIGINT or SIGTERM; what was done is kept where --checkpoint or --resume ask for it."},
};

constexpr std::pair<const char*, const char*> kEnvironment[] = {
    {"FROND_PLUGIN_PATH", "Folders, separated by colons, whose shared objects are loaded as by --plugin."},
    {"OCIO", "Configuration of OpenColorIO for --display and --view."},
    {"SOURCE_DATE_EPOCH", "Seconds since 1970 that files name as the time when they were written."},
    {"XDG_CACHE_HOME", "Tables that take time to compute are kept in its folder frond; ~/.cache where it is not set."},
};

std::string head(const CommandFacts& command, const std::string& doc) {
  std::string name = page_name(command);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return fmt::format(".TH {} 1 {:%Y-%m-%d} \"frond {}\" \"frond manual\"\n.SH NAME\n{}", escaped(name),
                     fmt::gmtime(file_time()), FROND_VERSION, paragraph(page_name(command) + " - " + doc));
}

/// frond(1).
std::string overview(std::span<const CommandFacts> commands) {
  const CommandFacts& frond = commands[0];
  std::string text = head(frond, "a spectral path tracer for plant leaves") + synopsis(frond) + ".SH DESCRIPTION\n";
  text += paragraph(
      "Reads scenes of pbrt-v4's format, renders leaves by models of their tissue, and measures materials and scenes. "
      "Each command has a page of its own.");
  text += ".SH COMMANDS\n";
  for (const CommandFacts& command : commands.subspan(1))
    text += ".TP\n\\fB" + escaped(page_name(command)) + "\\fR(1)\n" + paragraph(command.doc);
  return text + entries("OPTIONS", frond.options) + definitions("EXIT STATUS", kExitStatus) +
         definitions("ENVIRONMENT", kEnvironment);
}

std::string page(const CommandFacts& command) {
  std::string doc = first_sentence(command.doc);
  doc[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(doc[0])));
  std::string text = head(command, doc) + synopsis(command) + ".SH DESCRIPTION\n" + paragraph(command.doc);
  if (!command.footer.empty()) text += ".PP\n" + paragraph(command.footer);
  return text + entries("WORDS", command.words) + entries("OPTIONS", command.options) +
         ".SH SEE ALSO\n\\fBfrond\\fR(1): exit status and environment\n";
}

struct ManualOptions {
  std::string command, folder;
};

void write_manual(const CLI::App& app, const ManualOptions& o) {
  const auto commands = command_facts(app);
  bool found = false;
  for (const CommandFacts& command : commands) {
    const std::string text = command.name.empty() ? overview(commands) : page(command);
    if (!o.folder.empty()) {
      fs::create_directories(o.folder);
      write_text((fs::path(o.folder) / (page_name(command) + ".1")).string(), text);
    } else if (command.name == o.command) {
      found = true;
      write_text("-", text);
    }
  }
  if (found || !o.folder.empty()) return;
  std::vector<std::string_view> names;
  for (const CommandFacts& command : commands) names.push_back(command.name);
  fail({}, "there is no command \"{}\"{}", o.command, suggestion(o.command, names));
}

}  // namespace

void add_man_command(CLI::App& app) {
  auto* command = app.add_subcommand("man", "Print a man page: frond man render | man -l -");
  auto o = std::make_shared<ManualOptions>();
  command->add_option("command", o->command, "The command that it is of; frond itself by default.")
      ->type_name("COMMAND");
  command->add_option("--folder", o->folder, "Write the pages of all commands there.")->type_name("FOLDER");
  command->callback([&app, o] { write_manual(app, *o); });
}

}  // namespace frond
