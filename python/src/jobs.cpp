#include "render/parts/inputs.h"
#include "scene_handle.h"

namespace frond::python {
namespace {

using namespace nb::literals;

constexpr const char* kKinds[] = {"flag", "count", "seed", "real", "numbers", "text", "texts"};

nb::dict record_of(const JobParam& p) {
  nb::dict d;
  d["name"] = std::string(p.name), d["kind"] = kKinds[size_t(p.kind)], d["relative"] = p.relative,
  d["doc"] = parameter_help(p);
  d["type"] = std::string(p.type), d["default"] = std::string(p.default_value), d["unit"] = std::string(p.unit);
  d["choices"] = std::vector<std::string>(p.choices.begin(), p.choices.end());
  d["aliases"] = std::string(p.aliases), d["implied"] = std::string(p.implied);
  d["scene"] = p.scene, d["positional"] = p.positional, d["required"] = p.required, d["decides"] = p.decides;
  return d;
}

nb::list records_of(const std::vector<const JobParam*>& params) {
  nb::list all;
  for (const JobParam* p : params) all.append(record_of(*p));
  return all;
}

nb::dict record_of(const JobInfo& job) {
  const auto session = session_params(job.session);
  auto params = params_of(job);
  params.resize(params.size() - session.size());
  nb::dict d;
  d["name"] = std::string(job.name), d["group"] = std::string(job.group);
  d["doc"] = std::string(job.doc), d["details"] = std::string(job.details);
  d["params"] = records_of(params);
  return d;
}

nb::dict columns_of(Table& table) {
  nb::dict columns;
  for (Column& c : table.columns) {
    const nb::str name(c.name.c_str());
    if (c.is_number())
      columns[name] = to_array(std::move(std::get<0>(c.values)), {c.size()});
    else
      columns[name] = std::get<1>(c.values);
  }
  return columns;
}

nb::dict result_of(Result result) {
  nb::dict tables, facts, d;
  for (Table& table : result.tables) tables[nb::str(table.name.c_str())] = columns_of(table);
  for (const Fact& fact : result.facts)
    std::visit([&](const auto& value) { facts[nb::str(fact.name.c_str())] = value; }, fact.value);
  d["tables"] = tables, d["facts"] = facts, d["notes"] = result.notes, d["text"] = result.text, d["code"] = result.code;
  return d;
}

}  // namespace

Arguments arguments_of(const JobInfo& job, const GivenArguments& given) {
  Arguments args(params_of(job), python_spelling);
  for (const auto& [name, words] : given) args.set(name, words);
  return args;
}

void bind_jobs(nb::module_& m) {
  m.def("jobs", [] {
    nb::list all;
    for (const JobInfo* job : all_jobs())
      if (job->group != "Shell") all.append(record_of(*job));
    return all;
  });
  m.def("session_params", [] {
    nb::list all;
    for (const JobParam& p : session_params(SessionUse::all)) all.append(record_of(p));
    return all;
  });
  m.def(
      "parse_numbers", [](const std::string& text) { return parse_numbers(text); }, "text"_a);
  m.def(
      "check_arguments",
      [](const std::string& name, const GivenArguments& given) { arguments_of(find_job(name), given).check(); },
      "job"_a, "arguments"_a);
  m.def("default_cache", [] { return default_cache().string(); });
  m.def(
      "run",
      [](const std::shared_ptr<SessionHandle>& owner, const std::string& name, const GivenArguments& given,
         const nb::object& progress, const std::map<size_t, std::shared_ptr<SceneHandle>>& scenes) {
        const JobInfo& job = find_job(name);
        Arguments args = arguments_of(job, given);
        std::map<size_t, SceneInMemory> in_memory;
        for (const auto& [index, handle] : scenes) in_memory.emplace(index, handle->in_memory());
        const auto of_job = given_scenes(in_memory, args);
        Result result;
        const auto work = [&](const RenderControl& control) {
          try {
            result = run_job(job, {owner->context, args, control, of_job});
          } catch (const nb::python_error&) {  // of a BSDF written in Python
            throw;
          } catch (...) {
            rethrow_naming_plugins(owner->context.options().plugins);
          }
        };
        run(work, progress);
        return result_of(std::move(result));
      },
      "session"_a, "job"_a, "arguments"_a, "progress"_a.none(),
      "scenes"_a = std::map<size_t, std::shared_ptr<SceneHandle>>());
}

}  // namespace frond::python
