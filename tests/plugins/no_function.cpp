// A shared object, but no plug-in.
extern "C" int frond_plug_in() { return 0; }
