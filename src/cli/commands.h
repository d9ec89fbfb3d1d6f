#pragma once

namespace CLI {
class App;
}

namespace frond {

// One file for each subcommand: adds itself to the command line, and runs when chosen.
void add_render_command(CLI::App& app);
void add_merge_command(CLI::App& app);
void add_submit_command(CLI::App& app);
void add_compare_command(CLI::App& app);
void add_check_command(CLI::App& app);
void add_convert_command(CLI::App& app);
void add_difference_command(CLI::App& app);
void add_list_command(CLI::App& app);
void add_describe_command(CLI::App& app);
void add_table_command(CLI::App& app);
void add_fit_command(CLI::App& app);
void add_brf_command(CLI::App& app);
void add_flux_command(CLI::App& app);
void add_canopy_command(CLI::App& app);
void add_instances_command(CLI::App& app);
void add_conform_command(CLI::App& app);
void add_bench_command(CLI::App& app);
void add_man_command(CLI::App& app);
void add_completion_command(CLI::App& app);
void add_spectrophotometer_command(CLI::App& app);
void add_goniophotometer_command(CLI::App& app);
void add_export_command(CLI::App& app);

/// Runs the frond command. 0: done; 1: bad use or bad input, with a message on standard error; 2: `conform` found a law
/// broken; 75: another frond is at work on the same part; 130, 143: stopped by SIGINT or SIGTERM, what was done is
/// kept.
int run(int argc, const char* const* argv);

}  // namespace frond
