/// All of the library's public headers.
#pragma once

