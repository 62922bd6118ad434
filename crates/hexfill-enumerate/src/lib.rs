//! Every hex mesh with n cubes, without isomorphic copies (BruteBuilder)
