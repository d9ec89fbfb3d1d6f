# frond_hash_of_code(VARIABLE TEXT): a hash of C++ that comments to the end of a line do not change.
function(frond_hash_of_code variable text)
  string(REGEX REPLACE "[ \t]*//[^\"\n]*\n" "\n" code "${text}\n")
  string(REGEX REPLACE "\n+" "\n" code "\n${code}")
  string(SHA256 hash "${code}")
  string(SUBSTRING ${hash} 0 16 hash)
  set(${variable} ${hash} PARENT_SCOPE)
endfunction()
