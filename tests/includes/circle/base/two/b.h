#include "base/one/a.h"
