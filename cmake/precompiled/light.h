// The same for modules above render/ (frond_layers_light).
#include "library.h"
#include "render/session.h"
#include "report/table.h"
