child=
trap '[ -z "$child" ] || kill -TERM "$child"' TERM INT
"$@" &
child=$!
while :; do
    wait "$child"
    code=$?
    kill -0 "$child" 2>/dev/null || break
done
