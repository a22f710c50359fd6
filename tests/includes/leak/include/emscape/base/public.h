#include "base/internal.h"
