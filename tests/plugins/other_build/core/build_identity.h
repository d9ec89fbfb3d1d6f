#pragma once

#define FROND_BUILD_IDENTITY "frond 0.0.1 (contracts of old)"
