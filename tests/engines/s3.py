"""A bucket of the S3 server that AWS_ENDPOINT_URL names, for check.sh.

    python s3.py make BUCKET DIR PREFIX      makes the bucket and sends the files of a folder
    python s3.py has BUCKET KEY              fails where there is no such file
    python s3.py fetch BUCKET PREFIX DIR     fetches all files below a prefix
    python s3.py remove BUCKET KEY...
    python s3.py count BUCKET PREFIX ENDING  prints how many files end so
"""

import sys
from pathlib import Path

import boto3
from botocore.config import Config
from botocore.exceptions import BotoCoreError, ClientError

s3 = boto3.client("s3", config=Config(retries={"max_attempts": 0}, connect_timeout=2, read_timeout=10))


def keys(bucket, prefix):
    pages = s3.get_paginator("list_objects_v2").paginate(Bucket=bucket, Prefix=prefix)
    return [found["Key"] for page in pages for found in page.get("Contents", [])]


def make(bucket, folder, prefix):
    s3.create_bucket(Bucket=bucket)
    for path in Path(folder).iterdir():
        s3.upload_file(str(path), bucket, f"{prefix}/{path.name}")


def has(bucket, key):
    s3.head_object(Bucket=bucket, Key=key)


def fetch(bucket, prefix, folder):
    for key in keys(bucket, f"{prefix}/"):
        path = Path(folder) / key.removeprefix(f"{prefix}/")
        path.parent.mkdir(parents=True, exist_ok=True)
        s3.download_file(bucket, key, str(path))


def remove(bucket, *names):
    for key in names:
        s3.delete_object(Bucket=bucket, Key=key)


def count(bucket, prefix, ending):
    print(sum(key.endswith(ending) for key in keys(bucket, prefix)))


try:
    {"make": make, "has": has, "fetch": fetch, "remove": remove, "count": count}[sys.argv[1]](*sys.argv[2:])
except (BotoCoreError, ClientError) as e:
    sys.exit(str(e))
