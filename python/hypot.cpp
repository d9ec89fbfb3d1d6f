/// hypot by the version of its symbol that every glibc has, for a wheel (CMakeLists.txt): glibc 2.35 has another one,
/// of the same value, which differs in how it reports overflow. Calls of hypot are linked to __wrap_hypot by the
/// linker's option --wrap.
extern "C" {
double frond_hypot(double x, double y);
float frond_hypotf(float x, float y);
__asm__(".symver frond_hypot,hypot@GLIBC_2.2.5");
__asm__(".symver frond_hypotf,hypotf@GLIBC_2.2.5");
double __wrap_hypot(double x, double y) { return frond_hypot(x, y); }
float __wrap_hypotf(float x, float y) { return frond_hypotf(x, y); }
}
