# Of a compare.csv of frond compare (all pixels, all channels): lines of scripts/demo's table, the time of each model until an RMS
# error. The first error is that of abm's last run, which both models have measured; the second is below the bias of leaf_simplified.
# Appends to the file `rays`: scene, microseconds a ray of abm and of leaf_simplified, ratio of their noise variances.
#   awk -F, -v scene=NAME -v rays=FILE -f demo_costs.awk compare.csv
/^#/ { next }
!time { for (i = 1; i <= NF; ++i) at[$i] = i; time = at["cpu_seconds"]; next }
$at["region"] != "all" || $at["channel"] != "rgb" { next }
{
  model = $at["candidate"]; k = ++runs[model]
  seconds[model, k] = $time; rms[model, k] = $at["rms"]; bias[model] = $at["bias"]; low[model] = $at["bias_low"]
  high[model] = $at["bias_high"]; noise[model] = $at["noise"]
  ray[model] = ($time - $at["setup_cpu_seconds"]) / $at["rays"] * 1e6
}
function text(s) { return sprintf(s < 10 ? "%.2g s" : "%.0f s", s) }
# Returns the time until an error as text: between two points by a power law, beyond the last one of abm with noise that falls as
# the root of the time.
function until(model, error,   k, n, share) {
  n = runs[model]
  if (rms[model, 1] <= error) return "at most " text(seconds[model, 1])
  for (k = 2; k <= n; ++k)
    if (rms[model, k] <= error) {
      share = log(rms[model, k - 1] / error) / log(rms[model, k - 1] / rms[model, k])
      return text(seconds[model, k - 1] * (seconds[model, k] / seconds[model, k - 1]) ^ share)
    }
  if (model == "abm") return text(seconds[model, n] * (noise[model] / error) ^ 2) ", extrapolated"
  return low[model] >= error ? sprintf("not reached: its bias is %.4f", bias[model]) : "not measured"
}
function row(error) { printf "  %-8s  %-9.4f  %-22s  %s\n", scene, error, until("abm", error), until("leaf_simplified", error) }
END {
  row(rms["abm", runs["abm"]])
  if (low["leaf_simplified"] > 0) row(sprintf("%.1g", bias["leaf_simplified"] / 2) + 0)
  else printf "  %-8s  the bias of leaf_simplified is at most %.4f (95 %% confidence)\n", scene, high["leaf_simplified"]
  printf "%s %.2f %.2f %.0f\n", scene, ray["abm"], ray["leaf_simplified"], (noise["abm"] / noise["leaf_simplified"]) ^ 2 >>rays
}
