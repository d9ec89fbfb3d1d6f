// CSV files of `frond instances`. What it writes must be readable as an instance table.

#include "jobs/record/job.h"
#include "scene/geometry/instance_table.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(instance_csv, bytes) {
  static const ThreadPool pool(1);
  static const JobInfo& job = find_job("instances");
  const auto csv = fuzz::folder().write("rows.csv", bytes), npy = fuzz::folder().path() / "rows.npy";
  Arguments args(params_of(job), command_spelling);
  args.set("csv", csv.string());
  args.set("output", npy.string());
  JobContext context(silent_log(), {});
  if (!fuzz::accepts([&] { job.run({context, args}); })) return;
  fuzz::require(std::filesystem::file_size(npy) <= 1024 + 128 * bytes.size(),
                "the table's size follows from the CSV's");
  fuzz::accepts([&] { InstanceTable(npy, {}, pool); });
}
